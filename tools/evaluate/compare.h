// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/evaluate/aggregate.h"

#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// What a JSON report tells of an earlier run.
struct EarlierRun {
  struct Sentence {
    std::string key;
    std::int64_t frame_count = 0;
    MeasureValues values;
  };
  struct Method {
    std::string id;
    std::vector<Sentence> sentences; // in order of key
  };
  std::string source; // path, for messages
  std::string corpus;
  std::string held_out_by;
  double rate_hz = 0.0;
  std::vector<Measure> measures; // that it holds and this program knows
  std::vector<Method> methods;
  std::string main_method;
};

// Reads the JSON report of evaluate. `where` names the file in errors. Throws InputError: no
// report, another version, or measures of other names, units or formulas than this program's.
EarlierRun parse_evaluation(std::string_view json_text, std::string_view where);

enum class Verdict { better, worse, no_difference, not_compared };
std::string_view verdict_name(Verdict verdict); // "better", "worse", "no difference", ""

// One measure of two runs, over the sentences for which both have a value.
struct MeasureComparison {
  Measure measure = Measure::squared_error;
  std::int64_t sentences = 0;
  double mean = 0.0;                       // of this run
  double earlier_mean = 0.0;               // of the earlier one, over the same sentences
  double difference = 0.0;                 // mean less earlier_mean
  std::int64_t better = 0, worse = 0;      // sentences
  double p_value = 1.0;                    // Wilcoxon's signed-rank test, two-sided, of the badness
  double adjusted_p = 1.0;                 // after Holm, over the measures compared
  Verdict verdict = Verdict::not_compared; // at kSignificance of adjusted_p; direction by the sum
                                           // of signed ranks
};
inline constexpr double kSignificance = 0.05;

struct MethodComparison {
  std::string method;
  std::string earlier_method;
  std::int64_t sentences = 0; // that both runs hold
  std::vector<MeasureComparison> measures;
};

struct Comparison {
  std::string source; // of the earlier run
  std::string earlier_held_out_by;
  std::vector<std::string> notes; // what differs between the runs beside the results
  std::vector<MethodComparison> methods;
};

// Pairs the sentences of both runs by key, method by method: methods of the same id, and the two
// main methods where their ids differ. Throws InputError where the runs cannot be compared: other
// corpus, rate or frame counts, no sentence or no method in common.
Comparison compare_runs(const Evaluation& evaluation, const EarlierRun& earlier);

} // namespace phonomime
