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

// A step of 20 nodes before one of many, whose joins cost anything.
class Steps {
public:
  explicit Steps(std::uint64_t seed)
      : draw_(seed), table_(random_table(draw_)), kernels_(table_, test::random_weights(draw_)),
        frontier_(JoinFrontier::Side::later, kernels_, test::all_nodes(table_)) {
    const std::size_t size = frontier_.nodes().size();
    for (std::size_t i = 0; i < kNodes * size; ++i) {
      joins_.push_back(draw_.chance(0.1) ? 0.0 : 5.0 * draw_.unit());
    }
    std::vector<double> values(size);
    for (double& value : values) {
      value = draw_.chance(0.2) ? kInfinity : 4.0 * draw_.unit();
    }
    frontier_.set_values(values);
  }

  // Some values rise, much or little; some nodes are taken away.
  void change() {
    std::vector<double> values = frontier_.values();
    const double share = draw_.unit();
    for (double& value : values) {
      value += draw_.chance(0.1) ? 0.0 : share + draw_.unit() * draw_.unit();
      value = draw_.chance(0.1) ? kInfinity : value;
    }
    frontier_.set_values(values);
  }

  // All that is to be known of a node: its least joins, by looking at each.
  LeastJoins look(std::size_t place, std::size_t most) const {
    LeastJoins least(most);
    for (std::size_t i = 0; i < frontier_.nodes().size(); ++i) {
      if (frontier_.values()[i] < kInfinity) {
        least.consider(frontier_.candidate(i), joins_[place * frontier_.nodes().size() + i]);
      }
    }
    return least;
  }

  const JoinFrontier& frontier() const { return frontier_; }
  bool chance(double p) { return draw_.chance(p); }

private:
  static MotionTable random_table(Draw& draw) {
    test::TableShape shape;
    shape.sentences = 8 + draw.below(40); // up to some 200 nodes
    return test::random_table(shape, draw);
  }

  Draw draw_;
  MotionTable table_;
  JoinKernels kernels_;
  JoinFrontier frontier_;
  std::vector<double> joins_; // kNodes by as many as candidates
};

TEST(KeptJoins, never_say_more_than_a_look_at_every_neighbour) {
  int sure = 0;
  int all = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Steps steps(seed);
    KeptJoins kept;
    kept.reset(kNodes);
    for (std::size_t place = 0; place < kNodes; ++place) {
      kept.keep(place, steps.look(place, 1 + place % LeastJoins::kMost));
    }
    for (int change = 0; change < 6; ++change) {
      const std::vector<double> before = steps.frontier().values();
      steps.change();
      kept.renew(before, steps.frontier().values());
      for (std::size_t place = 0; place < kNodes; ++place) {
        const LeastJoins judged = steps.look(place, 1);
        const KeptJoins::Least least = kept.least(place, steps.frontier());
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
        } else if (steps.chance(0.5)) { // look again, from what is known
          const LeastJoins again = kept.joins(place, steps.frontier(), kInfinity);
          for (const LeastJoins::Join& join : again.joins()) {
            EXPECT_LT(join.value, kInfinity);
          }
          kept.keep(place, steps.look(place, LeastJoins::kMost));
          EXPECT_NEAR(kept.least(place, steps.frontier()).value, judged.value(),
                      1e-6 * judged.value());
        }
      }
    }
  }
  EXPECT_GT(sure, all / 4); // else nothing would be gained
}

} // namespace
} // namespace phonomime
