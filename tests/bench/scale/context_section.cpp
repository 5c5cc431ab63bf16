// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/cost_weights.h"
#include "synth/search/viterbi_search.h"
#include "tests/bench/compare.h"
#include "tests/bench/scale/measure.h"
#include "tests/bench/scale/sections.h"

namespace phonomime::bench {

namespace {

constexpr int kPaths = 8;

// The terms of each step, summed as the search does, give the path's cost.
void judge_terms(const NodePath& path, const std::string& what) {
  double sum = 0.0;
  for (std::size_t t = 0; t < path.steps.size(); ++t) {
    const StepCost& step = path.steps[t];
    const double penalty = (step.observation + step.emotion) + step.fit.sum();
    sum = t == 0 ? penalty : (sum + step.transition) + penalty;
  }
  verify(sum == path.cost, what + ": the cost is not that of its terms");
}

void judge_paths(const DisjointPaths& paths, const NodePath& alone, const std::string& what) {
  verify(same_path(paths.best.path, alone), what + ": the best path is another");
  for (const NodePath& path : paths.others) {
    judge_terms(path, what);
    verify(path.cost >= alone.cost, what + ": a later path is cheaper than the best");
  }
}

} // namespace

void report_context(Report& report, const ScaleOptions& options, const std::vector<Subject>& all) {
  report.section("The cost with context, and eight blended paths (ms, warm; share of the phrase's "
                 "duration; x = of the time of one path)",
                 {"database        ", "phrase", "cold 1t", "1 thread", "2 threads", "share",
                  "eight 2t", "x", "alive", "transitions"});
  for (const Subject& subject : all) {
    const CostWeights weights = default_cost_weights(subject.table, CostModel::context);
    ViterbiSearch search(subject.table, weights);
    for (const Phrase& phrase : subject.phrases) {
      const std::string what = subject.name + ", " + phrase.name + ", context";
      const SearchResult answer = search.solve(phrase.steps, {.threads = 2});
      ViterbiSearch fresh(subject.table, weights);
      SearchResult cold;
      const double cold_s =
          seconds([&] { return cold = fresh.solve(phrase.steps, {.threads = 1}); });
      verify(same_path(answer.path, cold.path),
             what + ": the answer depends on threads or earlier searches");
      judge_terms(answer.path, what);
      judge_paths(search.solve_disjoint(phrase.steps, kPaths, {.threads = 2}), answer.path, what);
      std::vector<double> one, two, eight;
      for (int run = 0; run < options.runs; ++run) {
        one.push_back(1e3 * seconds([&] { return search.solve(phrase.steps, {.threads = 1}); }));
        two.push_back(1e3 * seconds([&] { return search.solve(phrase.steps, {.threads = 2}); }));
        eight.push_back(1e3 * seconds([&] {
                          return search.solve_disjoint(phrase.steps, kPaths, {.threads = 2});
                        }));
      }
      const auto states = static_cast<double>(subject.table.node_count()) *
                          static_cast<double>(phrase.steps.size());
      report.row({subject.name, phrase.name, 1e3 * cold_s, median(one), median(two),
                  1e-3 * median(two) / phrase.duration_s, median(eight),
                  median(eight) / median(two), static_cast<double>(answer.counts.states) / states,
                  static_cast<double>(answer.counts.transitions)});
    }
  }
}

} // namespace phonomime::bench
