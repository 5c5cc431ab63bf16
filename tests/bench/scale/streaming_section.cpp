// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/streaming_search.h"
#include "synth/search/viterbi_search.h"
#include "tests/bench/compare.h"
#include "tests/bench/scale/measure.h"
#include "tests/bench/scale/sections.h"

#include <algorithm>

namespace phonomime::bench {

namespace {

struct Streamed {
  std::vector<double> step_ms; // of every push, and of finish()
  double cost = 0.0;
  double lower_bound = 0.0;
};

Streamed stream(ViterbiSearch& search, const Subject& subject, const Phrase& phrase,
                int look_ahead) {
  Streamed result;
  StreamingSearch streaming(search, look_ahead, {.threads = 2});
  std::vector<NodeIndex> nodes;
  for (const SearchStep& step : phrase.steps) {
    std::vector<NodeIndex> final_nodes;
    result.step_ms.push_back(1e3 * seconds([&] {
                               final_nodes = streaming.push(step);
                               return final_nodes.size();
                             }));
    nodes.insert(nodes.end(), final_nodes.begin(), final_nodes.end());
  }
  std::vector<NodeIndex> rest;
  result.step_ms.push_back(1e3 * seconds([&] {
                             rest = streaming.finish();
                             return rest.size();
                           }));
  nodes.insert(nodes.end(), rest.begin(), rest.end());
  verify(nodes.size() == phrase.steps.size(), "a stream does not end with a node for every step");
  JoinCost cost(subject.table, subject.weights);
  cost.ensure(nodes);
  result.cost = cost_of_path(cost, phrase.steps, nodes);
  result.lower_bound = streaming.lower_bound();
  return result;
}

} // namespace

void report_streaming(Report& report, const ScaleOptions& options,
                      const std::vector<Subject>& all) {
  report.section("Streaming (ms a phoneme, warm, 2 threads; excess = cost over the optimum, per "
                 "cent, over all transcripts; stated = what the search itself says at most)",
                 {"database        ", "look-ahead", "median", "90 %", "most", "transcripts",
                  "excess 50 %", "excess 90 %", "most excess", "stated 50 %"});
  for (const Subject& subject : all) {
    std::vector<Phrase> phrases = subject.phrases;
    std::ranges::move(random_phrases(subject.table, options.transcripts, 2007),
                      std::back_inserter(phrases));
    ViterbiSearch search(subject.table, subject.weights);
    std::vector<double> optimum;
    for (const Phrase& phrase : phrases) {
      optimum.push_back(search.solve(phrase.steps).path.cost);
    }
    for (const int look_ahead : {2, 3, 5, 8}) {
      std::vector<double> step_ms;
      std::vector<double> excess;
      std::vector<double> stated;
      for (std::size_t i = 0; i < phrases.size(); ++i) {
        const Streamed streamed = stream(search, subject, phrases[i], look_ahead);
        const double rounding = 1e-9 * optimum[i];
        verify(streamed.cost >= optimum[i] - rounding, "a stream is cheaper than the optimum");
        verify(streamed.lower_bound <= optimum[i] + rounding,
               "a stream's lower bound is above the optimum");
        step_ms.insert(step_ms.end(), streamed.step_ms.begin(), streamed.step_ms.end());
        excess.push_back(100.0 * (streamed.cost / optimum[i] - 1.0));
        stated.push_back(100.0 * (streamed.cost / streamed.lower_bound - 1.0));
      }
      report.row({subject.name, static_cast<double>(look_ahead), quantile(step_ms, 0.5),
                  quantile(step_ms, 0.9), std::ranges::max(step_ms),
                  static_cast<double>(phrases.size()), quantile(excess, 0.5), quantile(excess, 0.9),
                  std::ranges::max(excess), quantile(stated, 0.5)});
    }
  }
}

} // namespace phonomime::bench
