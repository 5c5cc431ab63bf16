// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// What the HTML player shows (synth/export/player reads it as JSON).
struct PlayerDocument {
  struct Phoneme {
    std::string phoneme;
    double start_s = 0.0, end_s = 0.0;
    std::string node; // key; empty: none
    bool captured = false;
    double observation_cost = 0.0, emotion_cost = 0.0, transition_cost = 0.0;
    bool closure = false; // asks for closed lips
  };
  struct Emotion {
    double start_s = 0.0, end_s = 0.0;
    std::string emotion;
    std::string color; // "#rrggbb"
  };
  struct Vertex {
    int mesh = 0, primitive = 0, vertex = 0; // glTF
  };

  std::string title;
  double duration_s = 0.0;
  double fps = 30.0;
  std::string glb; // bytes
  std::string wav; // bytes; empty: silent
  std::vector<Phoneme> phonemes;
  std::vector<Emotion> emotions;
  std::map<std::string, Vertex> landmarks;
  std::vector<std::string> credits;
  bool synthetic = false;
};

// One HTML file that opens by a double click, without a network. Throws UsageError where this build
// has no player (it needs node and npm when it is built).
std::string player_html(const PlayerDocument& document);

// The page with its two slots filled; for player_html and its tests.
std::string fill_player_template(std::string_view page, const PlayerDocument& document);

} // namespace phonomime
