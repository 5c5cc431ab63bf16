// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"
#include "synth/search/viterbi_search.h"
#include "tests/bench/compare.h"
#include "tests/bench/scale/measure.h"
#include "tests/bench/scale/sections.h"
#include "tests/bench/scale/slow_exact.h"

#include <limits>
#include <optional>

namespace phonomime::bench {

namespace {

// Nothing where the time is up.
std::optional<SearchResult> solve_within(double limit_s, ViterbiSearch& search,
                                         const Phrase& phrase) {
  const TimeLimit limit(limit_s);
  try {
    return search.solve(phrase.steps, {.threads = 2}, limit.progress());
  } catch (const Interrupted&) {
    return std::nullopt;
  }
}

} // namespace

void report_soft(Report& report, const ScaleOptions& options, const std::vector<Subject>& all) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  report.section("Softer penalties: alpha5 and alpha6 divided (ms, warm, 2 threads; - = stopped at "
                 "the time limit)",
                 {"database        ", "phrase", "divided by", "time", "share", "alive", "bounds",
                  "transitions", "judged by"});
  for (const Subject& subject : all) {
    const auto nodes = static_cast<double>(subject.table.node_count());
    for (const double divisor : {1.0, 3.0, 10.0}) {
      CostWeights weights = subject.weights;
      weights.alpha5 /= divisor;
      weights.alpha6 /= divisor;
      ViterbiSearch search(subject.table, weights);
      for (const Phrase& phrase : subject.phrases) {
        const std::optional<SearchResult> answer = solve_within(options.limit_s, search, phrase);
        if (!answer) {
          report.row({subject.name, phrase.name, divisor, kNone, kNone, kNone, kNone, kNone,
                      std::string("-")});
          continue;
        }
        const bool slowly = subject.table.node_count() <= options.sizes.front();
        if (slowly) {
          verify(same_path(answer->path, slow_exact(subject.table, weights, phrase.steps)),
                 subject.name + ", " + phrase.name + ", soft penalties: another answer");
        }
        std::vector<double> ms;
        double spent_s = 0.0;
        while (ms.size() < static_cast<std::size_t>(options.runs) &&
               (ms.empty() || spent_s < options.limit_s)) {
          ms.push_back(1e3 * seconds([&] { return search.solve(phrase.steps, {.threads = 2}); }));
          spent_s += 1e-3 * ms.back();
        }
        const double alive = static_cast<double>(answer->counts.states) /
                             (nodes * static_cast<double>(phrase.steps.size()));
        report.row({subject.name, phrase.name, divisor, median(ms),
                    1e-3 * median(ms) / phrase.duration_s, alive,
                    static_cast<double>(answer->counts.bounds),
                    static_cast<double>(answer->counts.transitions),
                    std::string(slowly ? "slow exact" : "-")});
      }
    }
  }
}

} // namespace phonomime::bench
