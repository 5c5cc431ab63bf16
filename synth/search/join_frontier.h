// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/end_tree.h"
#include "synth/search/join_bound.h"
#include "synth/search/join_cost.h"
#include "synth/search/linear_features.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace phonomime {

// The costs of joins and what bounds them from below, from the cheapest to the exact.
struct JoinKernels {
  JoinKernels(const MotionTable& table, const CostWeights& weights)
      : JoinKernels(table, weights, largest_frame_norm(table)) {}

  // Makes bound and cost ready for joins of these nodes. Not for parallel regions.
  void ensure(std::span<const NodeIndex> nodes) {
    bound.ensure(nodes);
    cost.ensure(nodes);
  }

  JoinSketch sketch;
  JoinBound bound;
  JoinCost cost;

private:
  JoinKernels(const MotionTable& table, const CostWeights& weights, double largest_frame)
      : sketch(table, weights, largest_frame), bound(table, weights, largest_frame),
        cost(table, weights, largest_frame) {}
};

// The joins between one step's candidates and single nodes of the neighbouring step.
//
// A frontier holds candidates with the cost of everything on their side. A join is looked at in
// tiers, each of which sees only what the one before could not exclude: box and sketch (EndTree),
// cluster norms (JoinBound), the gaps of E7, the direct smoothing cost of E6. No tier is ever above
// the cost, and each sum below is associated as the exact one is, so that rounding cannot turn a
// bound into a cut.
class JoinFrontier {
public:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  enum class Side {
    earlier, // candidates are left behind: their last ends meet the first end of a later node
    later    // candidates are ahead: their first ends meet the last end of an earlier node
  };

  // `nodes` ascending; all of infinite value.
  JoinFrontier(Side side, const JoinKernels& kernels, std::span<const NodeIndex> nodes);
  JoinFrontier(Side side, const JoinKernels& kernels, std::span<const NodeIndex> nodes,
               std::vector<double> values)
      : JoinFrontier(side, kernels, nodes) {
    set_values(std::move(values));
  }

  // One a node. Those of an infinite value have no joins.
  void set_values(std::vector<double> values);

  // A candidate, as its place among all.
  struct Candidate {
    std::size_t place = 0;
    NodeIndex node = kNoNode;
    double value = kInfinity;
  };

  const std::vector<NodeIndex>& nodes() const { return nodes_; }
  const std::vector<double>& values() const { return values_; }
  Candidate candidate(std::size_t place) const { return {place, nodes_[place], values_[place]}; }

  struct Best {
    double value = std::numeric_limits<double>::infinity();
    NodeIndex node = kNoNode;
  };

  struct Counts {
    std::int64_t bounds = 0;
    std::int64_t transitions = 0;
  };

  // The joins of one node that are least, by lower bounds.
  class LeastJoins {
  public:
    static constexpr std::size_t kMost = 2;
    struct Join {
      std::size_t place = 0;    // the candidate's
      NodeIndex node = kNoNode; // the candidate
      double join = kInfinity;  // at most TC
      double value = kInfinity; // the candidate's + join
    };

    // At most `most` (up to kMost) joins, none above `limit`.
    explicit LeastJoins(std::size_t most = 1, double limit = kInfinity)
        : most_(most), limit_(limit) {}

    // By value.
    std::span<const Join> joins() const { return std::span(joins_).first(size_); }
    // With every other candidate the value + TC is at least this.
    double limit() const { return limit_; }
    double value() const { return size_ == 0 ? kInfinity : joins_[0].value; }
    NodeIndex node() const { return joins_[0].node; }

    void consider(const Candidate& candidate, double join) {
      const double value = candidate.value + join;
      if (value > limit_ || (size_ == most_ && value == limit_)) {
        return;
      }
      std::size_t place = size_ < most_ ? size_++ : size_ - 1;
      for (; place > 0 && joins_[place - 1].value > value; --place) {
        joins_[place] = joins_[place - 1];
      }
      joins_[place] = {candidate.place, candidate.node, join, value};
      if (size_ == most_) {
        limit_ = std::min(limit_, joins_[size_ - 1].value);
      }
    }

  private:
    std::size_t most_;
    double limit_;
    std::size_t size_ = 0;
    std::array<Join, kMost> joins_;
  };

  // The least (value + TC) + penalty over the candidates, for a join with `node`, ties to the
  // smallest candidate; nothing above `limit` is found. `kernels` must know all nodes. Thread-safe.
  Best best_join(NodeIndex node, double penalty, double limit, Counts& counts) const;

  enum class Tightness {
    rough, // by sketches: about a quarter below
    tight  // by the gaps of E7 and the direct smoothing cost: 1e-5 below
  };
  // What bound_joins() is to look at.
  struct BoundOptions {
    std::span<const NodeIndex> nodes; // each once; much the faster where neighbours are alike
    Tightness tightness = Tightness::rough;
    std::span<const double> limits; // one a node, or none at all: nothing above is found
    // One a node, in place of limits: what is known, by the present values, and needs no look.
    // As many joins are looked for as it may hold; else only the least one.
    std::span<const LeastJoins> known;
  };
  // For every node i the candidates with the least lower bounds of value + TC: calls
  // found(i, node, least) over threads. Rough bounds ask for nothing that JoinKernels::ensure()
  // makes.
  template <typename Found>
  void bound_joins(const BoundOptions& options, Counts& counts, const Found& found) const;

private:
  // Calls known(candidate, TC) where rule 1 or 4 says what a join with `node` costs, cheapest first
  // until it returns false, then join(candidate, penalty of rule 3, bound) for every other
  // candidate whose value + TC, at least `bound`, may be within limit().
  template <typename Limit, typename Known, typename Join>
  void visit_joins(NodeIndex node, Counts& counts, const Limit& limit, const Known& known,
                   const Join& join) const;

  // Adds to `least`, which may hold some already; the candidates in `hints` are tried first.
  void bound_join(NodeIndex node, Tightness tightness, std::span<const LeastJoins::Join> hints,
                  LeastJoins& least, Counts& counts) const;

  std::pair<NodeIndex, NodeIndex> in_time(NodeIndex candidate, NodeIndex node) const {
    return side_ == Side::earlier ? std::pair(candidate, node) : std::pair(node, candidate);
  }
  NodeIndex captured_partner(NodeIndex node) const;
  // The candidate that is this node, if there is one of a finite value.
  std::optional<Candidate> find(NodeIndex node) const;
  const MotionTable& table() const { return kernels_.cost.table(); }
  const MotionNode& info(NodeIndex node) const {
    return table().nodes[static_cast<std::size_t>(node)];
  }

  Side side_;
  const JoinKernels& kernels_;
  std::vector<NodeIndex> nodes_; // ascending; here and below candidates are places in it
  std::vector<double> values_;
  // Those whose joins rule 4 may price, by (value, node): all of them on the earlier side, those
  // without a predecessor on the later one.
  std::vector<std::size_t> starts_;
  std::vector<std::size_t> in_tree_; // the others, and all on the earlier side: its entries
  EndTree tree_;
};

// Calls work(i, counts) for i in [0, size) over threads, `chunk` at a time, and adds up the counts.
// `work` writes only what belongs to its i, so that the result does not depend on the number of
// threads; it must not throw.
template <typename Work>
void for_each_in_parallel(std::size_t size, JoinFrontier::Counts& counts, const Work& work,
                          int chunk = 16) {
  std::int64_t bounds = 0;
  std::int64_t transitions = 0;
#pragma omp parallel for schedule(dynamic, chunk) reduction(+ : bounds, transitions)               \
    if (size > static_cast<std::size_t>(3 * chunk))
  for (std::size_t i = 0; i < size; ++i) {
    JoinFrontier::Counts own;
    work(i, own);
    bounds += own.bounds;
    transitions += own.transitions;
  }
  counts.bounds += bounds;
  counts.transitions += transitions;
}

template <typename Found>
void JoinFrontier::bound_joins(const BoundOptions& options, Counts& counts,
                               const Found& found) const {
  // Neighbours have much the same best join, which is tried first.
  constexpr std::size_t kChunk = 16;
  const std::size_t size = options.nodes.size();
  for_each_in_parallel(
      (size + kChunk - 1) / kChunk, counts,
      [&](std::size_t chunk, Counts& own) {
        LeastJoins before;
        for (std::size_t i = chunk * kChunk; i < std::min(size, (chunk + 1) * kChunk); ++i) {
          LeastJoins least(1, options.limits.empty() ? kInfinity : options.limits[i]);
          if (!options.known.empty()) {
            least = options.known[i];
          }
          bound_join(options.nodes[i], options.tightness, before.joins(), least, own);
          found(i, options.nodes[i], std::as_const(least));
          before = least;
        }
      },
      1);
}

} // namespace phonomime
