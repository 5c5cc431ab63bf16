// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/synth/search/random_tables.h"

#include "synth/search/kept_joins.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using LeastJoins = JoinFrontier::LeastJoins;
using test::Draw;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kNodes = 20;
constexpr int kTable = 60;

// A step of 20 nodes before one of up to 60, whose joins cost anything.
class Steps {
public:
  explicit Steps(Draw& draw) : draw_(draw), value_of_(kTable, kInfinity) {
    for (std::size_t i = 0; i < kNodes * kTable; ++i) {
      joins_.push_back(draw.chance(0.1) ? 0.0 : 5.0 * draw.unit());
    }
    for (NodeIndex node = 0; node < kTable; ++node) {
      if (draw.chance(0.7)) {
        add(node);
      }
    }
  }

  // Some values rise, much or little; some nodes are taken away; some come in.
  void change() {
    for (const NodeIndex node : neighbours_) {
      double& value = value_of_[static_cast<std::size_t>(node)];
      value += draw_.chance(0.1) ? 0.0 : 1.0 + draw_.unit();
      value = draw_.chance(0.1) ? kInfinity : value;
    }
    const auto node = static_cast<NodeIndex>(draw_.below(kTable));
    if (draw_.chance(0.3) && !std::ranges::binary_search(neighbours_, node)) {
      add(node);
    }
  }

  // All that is to be known of a node: its least joins, by looking at each.
  LeastJoins look(std::size_t place, std::size_t most) const {
    LeastJoins least(most);
    for (const NodeIndex node : neighbours_) {
      if (value_of_[static_cast<std::size_t>(node)] < kInfinity) {
        least.consider({node, value_of_[static_cast<std::size_t>(node)]}, join(place, node));
      }
    }
    return least;
  }

  const std::vector<NodeIndex>& neighbours() const { return neighbours_; }
  std::vector<double> values() const {
    std::vector<double> values;
    for (const NodeIndex node : neighbours_) {
      values.push_back(value_of_[static_cast<std::size_t>(node)]);
    }
    return values;
  }
  const std::vector<double>& value_of() const { return value_of_; }

private:
  double join(std::size_t place, NodeIndex node) const {
    return joins_[place * kTable + static_cast<std::size_t>(node)];
  }
  void add(NodeIndex node) {
    neighbours_.insert(std::ranges::lower_bound(neighbours_, node), node);
    value_of_[static_cast<std::size_t>(node)] = 4.0 * draw_.unit();
  }

  Draw& draw_;
  std::vector<double> joins_; // kNodes by kTable
  std::vector<NodeIndex> neighbours_;
  std::vector<double> value_of_;
};

TEST(KeptJoins, never_say_more_than_a_look_at_every_neighbour) {
  int sure = 0;
  int all = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    Steps steps(draw);
    KeptJoins kept;
    kept.reset(kNodes, steps.neighbours(), steps.values());
    for (std::size_t place = 0; place < kNodes; ++place) {
      kept.keep(place, steps.look(place, 1 + place % LeastJoins::kMost));
    }
    for (int change = 0; change < 6; ++change) {
      steps.change();
      kept.renew(steps.neighbours(), steps.values());
      for (std::size_t place = 0; place < kNodes; ++place) {
        const LeastJoins judged = steps.look(place, 1);
        const KeptJoins::Least least = kept.least(place, steps.value_of());
        const double tolerance = 1e-6 * (1.0 + least.rest); // joins are kept as floats
        if (judged.joins().empty()) {
          EXPECT_EQ(least.value, kInfinity);
          continue;
        }
        EXPECT_LE(std::min(least.value, least.rest), judged.value() * (1.0 + 1e-12));
        EXPECT_GE(least.value, judged.value() - tolerance); // it is a neighbour's
        ++all;
        if (least.value <= least.rest) {
          ++sure;
          EXPECT_NEAR(least.value, judged.value(), 1e-6 * judged.value());
        } else if (draw.chance(0.5)) { // look again, from what is known
          LeastJoins again = kept.joins(place, steps.value_of(), kInfinity);
          for (const LeastJoins::Join& join : again.joins()) {
            EXPECT_LT(join.value, kInfinity);
          }
          kept.keep(place, steps.look(place, LeastJoins::kMost));
          EXPECT_NEAR(kept.least(place, steps.value_of()).value, judged.value(),
                      1e-6 * judged.value());
        }
      }
    }
  }
  EXPECT_GT(sure, all / 4); // else nothing would be gained
}

} // namespace
} // namespace phonomime
