// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/player_document.h"

#include "db/types/errors.h"
#include "synth/export/player_template.h"

#include <cstdint>

#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

std::string base64(std::string_view bytes) {
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t block = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto byte = i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u;
      block = (block << 8) | byte;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool padding = i + k > bytes.size();
      text += padding ? '=' : kAlphabet[(block >> (18 - 6 * k)) & 63u];
    }
  }
  return text;
}

std::string escape_html(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
    case '&':
      escaped += "&amp;";
      break;
    case '<':
      escaped += "&lt;";
      break;
    case '>':
      escaped += "&gt;";
      break;
    case '"':
      escaped += "&quot;";
      break;
    default:
      escaped += c;
    }
  }
  return escaped;
}

// JSON that may stand inside a script element: no "</script>", no "<!--".
std::string script_safe(std::string_view json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

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

void replace_slot(std::string& page, std::string_view slot, const std::string& content) {
  const std::size_t at = page.find(slot);
  if (at == std::string::npos) {
    throw InternalError({.what = "the player's page has no slot " + std::string(slot)});
  }
  page.replace(at, slot.size(), content);
}

} // namespace

std::string fill_player_template(std::string_view page, const PlayerDocument& document) {
  std::string filled(page);
  // The data first: its slot stands behind the title's, and a title may look like a slot.
  replace_slot(filled, "@PHONOMIME_DATA@", script_safe(to_json(document).dump()));
  replace_slot(filled, "@PHONOMIME_TITLE@", escape_html(document.title));
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
