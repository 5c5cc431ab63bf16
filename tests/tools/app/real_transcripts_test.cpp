// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/motion_database.h"
#include "synth/search/cost_weights.h"
#include "synth/search/search_session.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"
#include "tests/synth/search/plain_recursion.h"
#include "tools/app/import_corpus.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr NodeIndex kNodes = 1200;
constexpr std::size_t kTranscripts = 240;

// The first sentences of a table, up to a number of nodes.
MotionTable first_part(const MotionTable& table, NodeIndex nodes) {
  MotionTable part = table;
  auto end = static_cast<std::size_t>(nodes);
  while (table.nodes[end].sentence == table.nodes[end - 1].sentence) {
    ++end;
  }
  part.nodes.resize(end);
  return part;
}

// What was said in the recordings from `node` on: one transcript a sentence, inner pauses included.
std::vector<std::vector<SearchStep>> transcripts_from(const MotionTable& table, NodeIndex node) {
  std::vector<std::vector<SearchStep>> transcripts;
  for (auto i = static_cast<std::size_t>(node);
       i < table.nodes.size() && transcripts.size() <= kTranscripts; ++i) {
    const MotionNode& info = table.nodes[i];
    if (info.sentence != table.nodes[i - 1].sentence) {
      transcripts.emplace_back();
    } else if (info.predecessor == kNoNode && !transcripts.empty()) {
      transcripts.back().push_back({.emotion = info.emotion, .is_silence = true});
    }
    if (!transcripts.empty()) {
      transcripts.back().push_back(
          {.phoneme = info.phoneme, .viseme = info.viseme, .emotion = info.emotion});
    }
  }
  transcripts.pop_back(); // may be cut off
  return transcripts;
}

// Algorithm 1 with every TC computed once and kept.
class KeptRecursion {
public:
  KeptRecursion(const MotionTable& table, const CostWeights& weights)
      : plain_(table, weights), size_(table.nodes.size()), transitions_(size_ * size_) {
#pragma omp parallel for schedule(dynamic)
    for (std::size_t to = 0; to < size_; ++to) {
      for (std::size_t from = 0; from < size_; ++from) {
        transitions_[to * size_ + from] =
            plain_.transition(static_cast<NodeIndex>(from), static_cast<NodeIndex>(to));
      }
    }
  }

  NodePath solve(const std::vector<SearchStep>& steps) const {
    std::vector<double> cost(size_);
    for (std::size_t i = 0; i < size_; ++i) {
      cost[i] = penalty(steps[0], i);
    }
    std::vector<std::vector<std::size_t>> before(steps.size(), std::vector<std::size_t>(size_));
    for (std::size_t t = 1; t < steps.size(); ++t) {
      std::vector<double> next(size_);
#pragma omp parallel for schedule(static)
      for (std::size_t to = 0; to < size_; ++to) {
        const double own = penalty(steps[t], to);
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t from = 0; from < size_; ++from) {
          const double value = (cost[from] + transitions_[to * size_ + from]) + own;
          if (value < least) {
            least = value;
            before[t][to] = from;
          }
        }
        next[to] = least;
      }
      cost = next;
    }
    std::size_t node = static_cast<std::size_t>(std::ranges::min_element(cost) - cost.begin());
    NodePath path;
    path.cost = cost[node];
    path.nodes.resize(steps.size());
    for (std::size_t t = steps.size(); t-- > 0;) {
      path.nodes[t] = static_cast<NodeIndex>(node);
      node = before[t][node];
    }
    return path;
  }

private:
  double penalty(const SearchStep& step, std::size_t node) const {
    const auto index = static_cast<NodeIndex>(node);
    return test::PlainRecursion::allowed(step, index) ? plain_.penalty(step, index)
                                                      : std::numeric_limits<double>::infinity();
  }

  test::PlainRecursion plain_;
  std::size_t size_;
  std::vector<double> transitions_; // row: later node
};

TEST(RealTranscripts, get_the_path_of_the_plain_recursion) {
  PHONOMIME_NEEDS_SHARED_DATA(shared);
  const test::TemporaryFolder scratch;
  ImportOptions import;
  import.corpus = shared / "grid_s1";
  import.database = scratch.path() / "grid.db";
  import_corpus(import, {});
  const MotionTable whole =
      MotionDatabase::open(import.database, OpenMode::read_only).load_motion_table("");
  const MotionTable table = first_part(whole, kNodes);
  const std::vector<std::vector<SearchStep>> transcripts =
      transcripts_from(whole, table.node_count());
  ASSERT_EQ(transcripts.size(), kTranscripts);
  // Penalties as shipped, and softer ones, which leave more states alive.
  for (const double softer : {1.0, 3.0, 10.0}) {
    CostWeights weights = default_cost_weights(table);
    weights.alpha5 /= softer;
    weights.alpha6 /= softer;
    const KeptRecursion judge(table, weights);
    ViterbiSearch search(table, weights);
    for (std::size_t i = 0; i < transcripts.size(); ++i) {
      SCOPED_TRACE(testing::Message() << "transcript " << i << ", penalties / " << softer);
      std::vector<SearchStep> steps = transcripts[i];
      const NodePath found = search.solve(steps).path;
      const NodePath judged = judge.solve(steps);
      ASSERT_EQ(found.cost, judged.cost);
      ASSERT_EQ(found.nodes, judged.nodes);
      if (i % 8 == 0) { // and an edit: the node in the middle banned
        SearchSession session(search);
        session.solve(steps);
        steps[steps.size() / 2].avoided = {found.nodes[steps.size() / 2]};
        const NodePath edited = session.solve(steps).path;
        const NodePath judged_edit = judge.solve(steps);
        ASSERT_EQ(edited.cost, judged_edit.cost);
        ASSERT_EQ(edited.nodes, judged_edit.nodes);
      }
    }
  }
}

} // namespace
} // namespace phonomime
