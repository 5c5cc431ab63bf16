// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/cost_weights.h"
#include "synth/search/viterbi_search.h"
#include "tests/bench/compare.h"
#include "tests/synth/search/plain_recursion.h"
#include "tests/synth/search/random_tables.h"

#include <vector>

#include <benchmark/benchmark.h>

namespace phonomime {
namespace {

// The search against Algorithm 1 as it is printed, over a made database of a face's size: 91
// markers, 25 dimensions, 38 phonemes, four emotions.
void search_against_plain_recursion(benchmark::State& state) {
  test::Draw draw(1);
  test::TableShape shape;
  shape.groups = 91;
  shape.dimensions = 25;
  shape.phonemes = 38;
  shape.visemes = 14;
  shape.emotions = 4;
  shape.longest_sentence = 30;
  shape.sentences = static_cast<int>(state.range(0)) / 14;
  const MotionTable table = test::random_table(shape, draw);
  const CostWeights weights = default_cost_weights(table);
  const std::vector<SearchStep> steps = test::random_steps(table, 53, draw, 0.02, 0.05);
  ViterbiSearch search(table, weights);
  const test::PlainRecursion plain(table, weights);
  const NodePath judged = plain.solve(steps);
  const NodePath found = search.solve(steps).path;
  bench::verify(found.cost == judged.cost && found.nodes == judged.nodes,
                "the search's path is not that of the plain recursion");
  state.counters["nodes"] = table.node_count();
  bench::compare(
      state, [&] { return search.solve(steps).path.cost; },
      [&] { return plain.solve(steps).cost; });
}
BENCHMARK(search_against_plain_recursion)
    ->Arg(700)
    ->Arg(1400)
    ->Iterations(3)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace phonomime
