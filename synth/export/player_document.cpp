// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/player_document.h"

#include "db/types/errors.h"
#include "db/types/html_text.h"
#include "synth/export/player_template.h"

#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

nlohmann::ordered_json to_json(const PlayerDocument& document) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["title"] = document.title;
  json["duration"] = document.duration_s;
  json["fps"] = document.fps;
  json["glb"] = base64(document.glb);
  json["audio"] = document.wav.empty() ? Json(nullptr) : Json(base64(document.wav));
  json["audio_type"] = "audio/wav";
  json["phonemes"] = Json::array();
  for (std::size_t i = 0; i < document.phonemes.size(); ++i) {
    const PlayerDocument::Phoneme& phoneme = document.phonemes[i];
    json["phonemes"].push_back({{"index", i},
                                {"phoneme", phoneme.phoneme},
                                {"start", phoneme.start_s},
                                {"end", phoneme.end_s},
                                {"node", phoneme.node.empty() ? Json(nullptr) : Json(phoneme.node)},
                                {"captured", phoneme.captured},
                                {"cost",
                                 {{"observation", phoneme.observation_cost},
                                  {"emotion", phoneme.emotion_cost},
                                  {"transition", phoneme.transition_cost}}},
                                {"closure", phoneme.closure}});
  }
  json["emotions"] = Json::array();
  for (const PlayerDocument::Emotion& span : document.emotions) {
    json["emotions"].push_back({{"start", span.start_s},
                                {"end", span.end_s},
                                {"emotion", span.emotion},
                                {"color", span.color}});
  }
  json["landmarks"] = Json::object();
  for (const auto& [name, vertex] : document.landmarks) {
    json["landmarks"][name] = {
        {"mesh", vertex.mesh}, {"primitive", vertex.primitive}, {"vertex", vertex.vertex}};
  }
  json["credits"] = document.credits;
  json["synthetic"] = document.synthetic;
  return json;
}

} // namespace

std::string fill_player_template(std::string_view page, const PlayerDocument& document) {
  std::string filled(page);
  // The data first: its slot stands behind the title's, and a title may look like a slot.
  fill_slot(filled, "@PHONOMIME_DATA@", script_safe(to_json(document).dump()));
  fill_slot(filled, "@PHONOMIME_TITLE@", escape_html(document.title));
  return filled;
}

std::string player_html(const PlayerDocument& document) {
  const std::string_view page = player_template();
  if (page.empty()) {
    throw UsageError({.what = "this build has no HTML player",
                      .remedy = "Install node (18 or later) and npm, and build again."});
  }
  return fill_player_template(page, document);
}

} // namespace phonomime
