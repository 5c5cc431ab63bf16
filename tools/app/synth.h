// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "db/types/progress.h"
#include "synth/concat/silence.h"
#include "synth/search/search_types.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

class SearchKeeper;
class SynthStock;

// The main job as a person asks for it. Empty paths and names are not given.
struct SynthOptions {
  std::filesystem::path database;
  std::filesystem::path transcript;
  std::vector<std::filesystem::path> outputs; // kind by suffix: .csv .glb .html .json .lab .txt
  std::string speaker;                        // needed where the database holds several
  std::string phoneme_set;                    // built-in name or file; empty: found by the symbols
  std::string tier;                           // of a TextGrid
  std::string emotion;                        // NAME or NAME:INTENSITY; empty: neutral
  std::filesystem::path emotions;             // emotion track
  std::filesystem::path constraints;
  std::optional<CostModel> cost;  // empty: kUsualCost, of a stream the paper's
  std::optional<int> blend;       // paths that are blended, 1 to 100; empty: kUsualBlend
  std::filesystem::path weights;  // of the cost, where they are not its own
  std::filesystem::path audio;    // WAV, goes into the HTML player
  std::filesystem::path face;     // needed for .glb and .html
  double fps = 30.0;              // 1 to 1000
  std::optional<HeadPose> head;   // constant; empty: the head rests
  bool retime = false;            // the transcript gets the tempo of its emotions ...
  bool retime_with_audio = false; // ... although there is a sound, which then no longer fits
  SilenceOptions silence;
  int smoothing_half_window = 3; // s of E16, frames, 0 to 100
  int runners_up = 3;            // per phoneme, 0 to 100, where a .json or .txt output tells them
  bool tells_result = false;     // as such an output does: the report's result_json is wanted
  int threads = 0;               // 0 = as many as there are cores
  bool make_folders = false;     // of the outputs, where they are missing
};

// What holds where the call says nothing else.
inline constexpr CostModel kUsualCost = CostModel::context;
inline constexpr int kUsualBlend = 8;

struct SynthReport {
  std::string result_json; // as `synth --json` prints it
  std::vector<std::filesystem::path> written;
  std::vector<std::string> warnings;
  std::vector<std::string> notes; // choices made for the user: phoneme set, face
  std::size_t phonemes = 0;
  double duration_s = 0.0;
  double cost = 0.0;
  int joins = 0;
  int captured_joins = 0;
};

// Opens the database, gathers plain data, calls the recipe (synth/pipeline) and writes every
// output, all or none. Throws UsageError, InputError, IoError and Interrupted.
SynthReport run_synth(const SynthOptions& options, const Progress& progress);

// The same, with recordings that have been loaded: those of options.speaker in options.database.
SynthReport run_synth(const SynthOptions& options, SynthStock& stock, SearchKeeper& keeper,
                      const Progress& progress);

} // namespace phonomime
