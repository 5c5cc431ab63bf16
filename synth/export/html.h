// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/export/glb.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// A phoneme as the page shows it.
struct PlayerPhoneme {
  int index = 0; // row of the transcript
  std::string phoneme;
  double start_s = 0.0;
  double end_s = 0.0;
  std::optional<std::string> node; // key; nothing for silence
  bool captured = false;           // follows the one before as recorded
  struct Cost {
    double observation = 0.0;
    double emotion = 0.0;
    double transition = 0.0;
  };
  std::optional<Cost> cost;
  bool closure = false; // its lips have to meet: /p b m/
};

struct PlayerEmotion {
  double start_s = 0.0;
  double end_s = 0.0;
  std::string emotion;
  std::string color; // CSS: "#c0392b"
};

// Where a landmark is in the GLB.
struct PlayerLandmark {
  int mesh = 0;
  int primitive = 0;
  int vertex = 0;
};

// All that one page holds. The player's own documentation of the fields: export/player/src/data.js.
struct PlayerDocument {
  ExportNotes notes;
  double duration_s = 0.0;
  double fps = 0.0;
  std::string glb;                  // bytes
  std::optional<std::string> audio; // bytes of a WAV file
  std::vector<PlayerPhoneme> phonemes;
  std::vector<PlayerEmotion> emotions;
  std::map<std::string, PlayerLandmark, std::less<>> landmarks;
};

// Whether this build holds the player's page (it needs node and npm when it is built).
bool has_player();

// One self-contained page. Throws UsageError where this build has no player.
std::string make_player_html(const PlayerDocument& document);

// The same into a page of one's own: @PHONOMIME_TITLE@ becomes the title as text,
// @PHONOMIME_DATA@ the document as JSON with `<` written \u003c. Throws InternalError where the
// page does not hold each of them once.
std::string fill_player_page(std::string_view page, const PlayerDocument& document);

} // namespace phonomime
