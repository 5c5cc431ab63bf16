// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/motion_file.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace phonomime {

inline constexpr const char* kUnknownEmotion = "unknown";

// A motion file that is to show another emotion.
struct StyleApplyOptions {
  std::filesystem::path database;
  std::filesystem::path motion;
  MotionFileOptions reading;
  std::string speaker;                // whose face and model; needed where there are several
  std::string from = kUnknownEmotion; // what the motion shows, as --emotion; or to be found
  std::string to;                     // what it is to show, as --emotion
  std::filesystem::path emotions;     // an emotion track; where it is silent, `to`
  std::filesystem::path transcript;   // what is said; empty: contacts are not kept
  std::string phoneme_set, tier;      // of the transcript
  std::vector<std::filesystem::path> outputs; // .csv .glb .html .json
  std::filesystem::path face;                 // needed for .glb and .html
  std::filesystem::path audio;                // WAV, goes into the HTML player
  std::optional<double> fps;                  // 1 to 1000; empty: the motion's own
  bool head = false;                          // put the head's motion back
  int threads = 0;                            // 0 = as many as there are
};

struct StyleApplyReport {
  std::string speaker;  // whose face
  std::string model_of; // whose model; another's: borrowed
  std::string unit;     // of change and residual: "mm a marker" or "a weight"
  std::string from;     // shown
  bool from_found = false;
  // Where it was found: how far the motion's style vector is from each trained one, nearest first.
  std::vector<std::pair<std::string, double>> distances;
  std::int64_t frames = 0;
  double fps = 0.0, duration_s = 0.0;
  double residual = 0.0; // root mean square of what the PCA does not hold; it stays as it is
  double change = 0.0;   // root mean square
  int contacts = 0, contacts_moved = 0, contacts_left = 0;
  std::vector<std::string> warnings, notes;
  std::vector<std::filesystem::path> written;
};

// The report as JSON, for --json and .json.
std::string style_apply_json(const StyleApplyReport& report);

// Reads the motion, finds its emotion where that is not known, changes it (apply_style) and writes
// every output, all or none. What lies outside the PCA stays in a .csv as it is. Throws UsageError,
// InputError and IoError; then nothing is written.
StyleApplyReport apply_style_to_file(const StyleApplyOptions& options);

} // namespace phonomime
