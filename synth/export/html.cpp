// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/html.h"

#include "db/types/errors.h"
#include "synth/export/base64.h"
#include "synth/export/player_page.h"

#include <nlohmann/json.hpp>

namespace phonomime {
namespace {

constexpr std::string_view kTitleSlot = "@PHONOMIME_TITLE@";
constexpr std::string_view kDataSlot = "@PHONOMIME_DATA@";

std::string as_html_text(std::string_view text) {
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

nlohmann::ordered_json to_json(const PlayerPhoneme& phoneme) {
  nlohmann::ordered_json json;
  json["index"] = phoneme.index;
  json["phoneme"] = phoneme.phoneme;
  json["start"] = phoneme.start_s;
  json["end"] = phoneme.end_s;
  json["node"] = nullptr;
  if (phoneme.node) {
    json["node"] = *phoneme.node;
  }
  json["captured"] = phoneme.captured;
  json["cost"] = nullptr;
  if (phoneme.cost) {
    json["cost"] = {{"observation", phoneme.cost->observation},
                    {"emotion", phoneme.cost->emotion},
                    {"transition", phoneme.cost->transition}};
  }
  json["closure"] = phoneme.closure;
  return json;
}

std::string data_of(const PlayerDocument& document) {
  nlohmann::ordered_json json;
  json["title"] = document.notes.title;
  json["duration"] = document.duration_s;
  json["fps"] = document.fps;
  json["phonemes"] = nlohmann::ordered_json::array();
  for (const PlayerPhoneme& phoneme : document.phonemes) {
    json["phonemes"].push_back(to_json(phoneme));
  }
  json["emotions"] = nlohmann::ordered_json::array();
  for (const PlayerEmotion& emotion : document.emotions) {
    json["emotions"].push_back({{"start", emotion.start_s},
                                {"end", emotion.end_s},
                                {"emotion", emotion.emotion},
                                {"color", emotion.color}});
  }
  json["landmarks"] = nlohmann::ordered_json::object();
  for (const auto& [name, place] : document.landmarks) {
    json["landmarks"][name] = {
        {"mesh", place.mesh}, {"primitive", place.primitive}, {"vertex", place.vertex}};
  }
  json["credits"] = document.notes.credits;
  json["synthetic"] = document.notes.synthetic;
  json["audio_type"] = "audio/wav";
  json["audio"] = nullptr;
  if (document.audio) {
    json["audio"] = base64(*document.audio);
  }
  json["glb"] = base64(document.glb);
  const std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      escaped += "\\u003c";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

// Where a slot stands in the page.
std::size_t place_of(std::string_view page, std::string_view slot) {
  const std::size_t place = page.find(slot);
  if (place == std::string_view::npos || page.find(slot, place + 1) != std::string_view::npos) {
    throw InternalError({.what = "the player's page must hold " + std::string(slot) + " once"});
  }
  return place;
}

} // namespace

bool has_player() {
  return !player_page().empty();
}

std::string make_player_html(const PlayerDocument& document) {
  if (!has_player()) {
    throw UsageError(
        {.what = "this build of Phonomime cannot write HTML: it has no player",
         .remedy = "Build it where node 18 and npm are installed, or ask for a .glb."});
  }
  return fill_player_page(player_page(), document);
}

std::string fill_player_page(std::string_view page, const PlayerDocument& document) {
  const std::size_t title = place_of(page, kTitleSlot);
  const std::size_t data = place_of(page, kDataSlot);
  if (data < title) {
    throw InternalError({.what = "the player's page must hold its title before its data"});
  }
  const std::size_t after_title = title + kTitleSlot.size();
  std::string filled(page.substr(0, title));
  filled += as_html_text(document.notes.title);
  filled += page.substr(after_title, data - after_title);
  filled += data_of(document);
  filled += page.substr(data + kDataSlot.size());
  return filled;
}

} // namespace phonomime
