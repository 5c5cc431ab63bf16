// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/viterbi_search.h"
#include "tests/bench/compare.h"
#include "tests/bench/scale/measure.h"
#include "tests/bench/scale/sections.h"
#include "tests/bench/scale/slow_exact.h"

#include <limits>
#include <map>
#include <numeric>

namespace phonomime::bench {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The answer with one thread, with two, of a search that knows nothing yet and of one that does
// must be one, its cost that of its nodes; the slow exact search judges where it can.
void judge(const Subject& subject, const Phrase& phrase, const NodePath& path, bool slowly) {
  const std::string what = subject.name + ", " + phrase.name;
  const NodePath one_thread =
      ViterbiSearch(subject.table, subject.weights).solve(phrase.steps, {.threads = 1}).path;
  verify(same_path(path, one_thread), what + ": the answer depends on threads or earlier searches");
  JoinCost cost(subject.table, subject.weights);
  cost.ensure(path.nodes);
  verify(cost_of_path(cost, phrase.steps, path.nodes) == path.cost,
         what + ": the cost is not that of the nodes");
  if (slowly) {
    verify(same_path(path, slow_exact(subject.table, subject.weights, phrase.steps)),
           what + ": the slow exact search has another answer");
  }
}

} // namespace

void report_search(Report& report, const ScaleOptions& options, const std::vector<Subject>& all) {
  report.section("The exact search, shipped weights (ms; share = warm, 2 threads, of the phrase's "
                 "duration; alive = states kept, of nodes x steps)",
                 {"database        ", "phrase", "cold 1t", "cold 2t", "warm 1t", "warm 2t", "share",
                  "alive", "bounds", "transitions", "judged by"});
  std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> growth;
  for (const Subject& subject : all) {
    ViterbiSearch search(subject.table, subject.weights);
    const auto nodes = static_cast<double>(subject.table.node_count());
    for (const Phrase& phrase : subject.phrases) {
      const SearchResult answer = search.solve(phrase.steps, {.threads = 2});
      const bool slowly = subject.table.node_count() <= options.verify_up_to;
      judge(subject, phrase, answer.path, slowly);
      std::map<std::string, double> ms;
      for (const int threads : {1, 2}) {
        std::vector<double> cold;
        std::vector<double> warm;
        for (int run = 0; run < options.runs; ++run) {
          ViterbiSearch fresh(subject.table, subject.weights);
          cold.push_back(1e3 *
                         seconds([&] { return fresh.solve(phrase.steps, {.threads = threads}); }));
          warm.push_back(1e3 *
                         seconds([&] { return fresh.solve(phrase.steps, {.threads = threads}); }));
        }
        ms["cold" + std::to_string(threads)] = median(cold);
        ms["warm" + std::to_string(threads)] = median(warm);
      }
      const auto steps = static_cast<double>(phrase.steps.size());
      report.row({subject.name, phrase.name, ms["cold1"], ms["cold2"], ms["warm1"], ms["warm2"],
                  1e-3 * ms["warm2"] / phrase.duration_s,
                  static_cast<double>(answer.counts.states) / (nodes * steps),
                  static_cast<double>(answer.counts.bounds),
                  static_cast<double>(answer.counts.transitions),
                  std::string(slowly ? "slow exact" : "itself")});
      const std::string source = subject.name.substr(0, subject.name.find(' '));
      growth[source + ", " + phrase.name].first.push_back(nodes);
      growth[source + ", " + phrase.name].second.push_back(ms["warm2"]);
    }
  }
  report.section("Its growth: exponent of the nodes in the time, warm, 2 threads",
                 {"database        ", "all sizes", "last two"});
  for (const auto& [name, points] : growth) {
    const auto& [nodes, ms] = points;
    const std::size_t from = nodes.size() < 2 ? 0 : nodes.size() - 2;
    report.row({name, nodes.size() < 2 ? kNone : fitted_exponent(nodes, ms),
                nodes.size() < 2 ? kNone
                                 : fitted_exponent(std::span(nodes).subspan(from),
                                                   std::span(ms).subspan(from))});
  }
}

} // namespace phonomime::bench
