// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/expected_motion.h"
#include "synth/search/node_classes.h"
#include "synth/search/node_records.h"
#include "synth/search/search_types.h"
#include "synth/search/surroundings.h"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace phonomime {

// What a table teaches about phonemes in context, and how well its nodes fit what a step asks for:
// the terms of the cost beyond the paper's (docs/cost.md), each a number without unit that its
// weight times pnt multiplies.
//
// target: the mean squared distance of the node's motion (five samples over its duration) from the
// motion that is expected there, over the variance of all motion. Lips count as much per group as
// four times the rest. What is expected is expected_motion.h's; a node that was recorded in just
// these surroundings, and as long, is what is expected there. context: how unlike the phonemes are
// that are said around, up to 0.3 s before and after, near ones counting more; two phonemes are as
// unlike as their mean poses, 1 on average. duration: the difference of the durations over their
// mean. position: difference of the places in the phrase, 0 to 1.
class ContextFit {
public:
  ContextFit(const MotionTable& table, const CostWeights& weights);

  // False where every weight beyond the paper's is 0; then nothing else may be asked for.
  bool counts() const { return counts_; }

  // What one step asks for. Silence asks for nothing.
  struct Wish {
    bool asks = false;
    Surroundings surroundings;
    std::vector<float> target;  // record_floats(): the expected motion; empty: none is known
    std::vector<float> context; // per look, per phoneme: weight * dissimilarity
  };
  // `classes` of the same table. Not for parallel regions: computes what it needs of nodes.
  Wish wish(const SearchStep& step, const NodeClasses& classes);

  // The expected motion of a step as coefficients, from its start to its end: five frames by
  // #dimensions; none where neither phoneme nor viseme was recorded. Not for parallel regions.
  FrameMatrixD expected_frames(const SearchStep& step, const NodeClasses& classes);

  // Computes what fit() asks of these nodes, ahead. Not for parallel regions.
  void ensure(std::span<const NodeIndex> nodes);

  // The terms times their weights and pnt. `ensured`: ensure() has seen the node; else slower.
  FitCost fit(const Wish& wish, NodeIndex node, bool ensured) const;

private:
  std::size_t record_floats() const { return kSamples * padded_; }
  void fill_record(NodeIndex node, float* record) const;
  const ExpectedMotion* expected_motion(const SearchStep& step, const NodeClasses& classes);
  bool recorded_just_so(const Surroundings& asked, const Surroundings& own) const;
  void learn_dissimilarities();
  float dissimilarity(std::int32_t a, std::int32_t b) const;

  static constexpr std::size_t kSamples = 5;

  const MotionTable& table_;
  CostWeights weights_;
  bool counts_;
  std::size_t padded_;     // dimensions, to whole vectors
  Eigen::MatrixXd metric_; // #dimensions square: |metric c|^2 is the distance
  Eigen::MatrixXd inverse_metric_;
  std::vector<Surroundings> surroundings_; // per node
  std::vector<float> dissimilarities_;     // #phonemes square
  // By phoneme and viseme; nothing where neither was recorded.
  std::map<std::pair<std::int32_t, std::int32_t>, std::optional<ExpectedMotion>> expected_;
  NodeRecords records_; // kSamples warped frames times metric_, padded
};

} // namespace phonomime
