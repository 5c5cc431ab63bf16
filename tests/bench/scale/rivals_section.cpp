// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/cost_weights.h"
#include "synth/search/viterbi_search.h"
#include "tests/bench/compare.h"
#include "tests/bench/scale/beam_search.h"
#include "tests/bench/scale/measure.h"
#include "tests/bench/scale/plain_vectorised.h"
#include "tests/bench/scale/scaled_table.h"
#include "tests/bench/scale/sections.h"

#include <algorithm>
#include <memory>
#include <numeric>

namespace phonomime::bench {

namespace {

// The phrase that E times: the one of 53 phonemes, or what is nearest to it here.
std::size_t middle_phrase(const std::vector<Phrase>& phrases) {
  const auto away = [](const Phrase& phrase) {
    return std::abs(static_cast<double>(phrase.steps.size()) - 53.0);
  };
  return static_cast<std::size_t>(std::ranges::min_element(phrases, {}, away) - phrases.begin());
}

} // namespace

void report_plain(Report& report, const ScaleOptions& options, const MotionTable& source) {
  constexpr double kSpread = 0.3;
  report.section(
      "The plain recursion, vectorised, on two threads, against the exact search (s; the "
      "53-phoneme phrase; TC = all joins, recursion = what is left once they are kept)",
      {"nodes", "phrase", "plain TC", "recursion", "plain", "exact cold", "exact warm",
       "plain/cold", "plain/warm", "recursion/warm"});
  std::vector<double> sizes;
  std::vector<double> joins_s;
  std::vector<double> recursion_s;
  std::vector<double> plain_s;
  for (const NodeIndex size : {700, 1400, 2778, 5556}) {
    const MotionTable table = scaled_table(source, size, kSpread);
    const CostWeights weights = default_cost_weights(table);
    const std::vector<Phrase> phrases = read_phrases(table, options.phrases);
    const Phrase& phrase = phrases.at(middle_phrase(phrases));
    ViterbiSearch search(table, weights);
    const NodePath path = search.solve(phrase.steps).path;
    std::vector<double> joins;
    std::vector<double> recursion;
    std::vector<double> cold;
    std::vector<double> warm;
    for (int run = 0; run < std::min(options.runs, 3); ++run) {
      std::unique_ptr<PlainVectorised> plain;
      joins.push_back(seconds([&] {
        plain = std::make_unique<PlainVectorised>(table, weights);
        return plain.get();
      }));
      verify(same_path(plain->solve(phrase.steps), path), "the plain recursion has another answer");
      recursion.push_back(seconds([&] { return plain->solve(phrase.steps); }));
    }
    for (int run = 0; run < options.runs; ++run) {
      ViterbiSearch fresh(table, weights);
      cold.push_back(seconds([&] { return fresh.solve(phrase.steps); }));
      warm.push_back(seconds([&] { return fresh.solve(phrase.steps); }));
    }
    const double plain = median(joins) + median(recursion);
    sizes.push_back(size);
    joins_s.push_back(median(joins));
    recursion_s.push_back(median(recursion));
    plain_s.push_back(plain);
    report.row({static_cast<double>(size), phrase.name, median(joins), median(recursion), plain,
                median(cold), median(warm), plain / median(cold), plain / median(warm),
                median(recursion) / median(warm)});
  }
  report.section("Its growth: exponent of the nodes", {"plain TC", "recursion", "plain"});
  report.row({fitted_exponent(sizes, joins_s), fitted_exponent(sizes, recursion_s),
              fitted_exponent(sizes, plain_s)});
}

void report_beam(Report& report, const ScaleOptions& options, const std::vector<Subject>& all) {
  report.section("A beam search against the exact one (ms, warm, 2 threads; excess = its cost over "
                 "the optimum, per cent)",
                 {"database        ", "phrase", "width", "beam", "exact", "excess %"});
  for (const Subject& subject : all) {
    JoinCost cost(subject.table, subject.weights);
    std::vector<NodeIndex> nodes(subject.table.nodes.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    cost.ensure(nodes);
    ViterbiSearch search(subject.table, subject.weights);
    for (const Phrase& phrase : subject.phrases) {
      const NodePath path = search.solve(phrase.steps).path;
      std::vector<double> exact;
      for (int run = 0; run < options.runs; ++run) {
        exact.push_back(1e3 * seconds([&] { return search.solve(phrase.steps); }));
      }
      for (const std::size_t width : {16U, 64U, 256U}) {
        const NodePath found = beam_search(cost, phrase.steps, width);
        verify(found.cost == cost_of_path(cost, phrase.steps, found.nodes) &&
                   found.cost >= path.cost,
               "the beam's cost is not that of its nodes, or below the optimum");
        std::vector<double> beam;
        for (int run = 0; run < std::min(options.runs, 3); ++run) {
          beam.push_back(1e3 * seconds([&] { return beam_search(cost, phrase.steps, width); }));
        }
        report.row({subject.name, phrase.name, static_cast<double>(width), median(beam),
                    median(exact), 100.0 * (found.cost / path.cost - 1.0)});
      }
    }
  }
}

} // namespace phonomime::bench
