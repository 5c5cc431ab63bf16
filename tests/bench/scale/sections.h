// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/bench/scale/phrases.h"
#include "tests/bench/scale/report.h"

#include "db/types/motion_table.h"
#include "synth/search/search_types.h"

#include <filesystem>
#include <string>
#include <vector>

namespace phonomime::bench {

struct ScaleOptions {
  std::vector<std::filesystem::path> databases;
  std::vector<std::filesystem::path> phrases;
  std::vector<NodeIndex> sizes = {5556, 20000, 80000};
  std::vector<std::string> only; // sections; empty = all
  std::filesystem::path json;    // empty = none
  int runs = 5;
  int transcripts = 48;           // of the streaming section, beside the phrases
  double limit_s = 20.0;          // for one search that may be slow
  NodeIndex verify_up_to = 20000; // nodes: where a slow exact search judges every phrase
  std::int64_t frames = 850000;   // of the database that is loaded
};

// A scaled database with what is to be said with it.
struct Subject {
  std::string name; // "demo 80000"
  MotionTable table;
  CostWeights weights; // the shipped ones of the paper's cost
  std::vector<Phrase> phrases;
};

// Each prints its tables and throws where an answer is wrong.
void report_search(Report& report, const ScaleOptions& options, const std::vector<Subject>& all);
void report_context(Report& report, const ScaleOptions& options, const std::vector<Subject>& all);
void report_plain(Report& report, const ScaleOptions& options, const MotionTable& source);
void report_beam(Report& report, const ScaleOptions& options, const std::vector<Subject>& all);
void report_soft(Report& report, const ScaleOptions& options, const std::vector<Subject>& all);
void report_loading(Report& report, const ScaleOptions& options);
void report_edits(Report& report, const ScaleOptions& options, const std::vector<Subject>& all);
void report_streaming(Report& report, const ScaleOptions& options, const std::vector<Subject>& all);

} // namespace phonomime::bench
