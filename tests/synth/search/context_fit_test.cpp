// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/context_fit.h"
#include "synth/search/viterbi_search.h"
#include "tests/synth/search/plain_recursion.h"
#include "tests/synth/search/random_tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::Draw;

test::TableShape some_shape(Draw& draw) {
  test::TableShape shape;
  shape.sentences = 2 + draw.below(12);
  shape.groups = 2 + draw.below(6);
  shape.lips = draw.below(shape.groups);
  shape.kind = draw.chance(0.25) ? LayoutKind::weights : LayoutKind::markers;
  shape.dimensions = 1 + draw.below(std::min(6, shape.groups));
  shape.emotions = 1 + draw.below(3);
  shape.phonemes = 2 + draw.below(6);
  return shape;
}

CostWeights context_weights(Draw& draw) {
  CostWeights weights = test::random_weights(draw);
  const auto weight = [&](double most) { return draw.chance(0.2) ? 0.0 : most * draw.unit(); };
  weights.target = weight(2.0);
  weights.context = weight(2.0);
  weights.duration = weight(1.0);
  weights.position = weight(1.0);
  weights.off_lips = draw.chance(0.3) ? 1.0 : draw.unit();
  return weights;
}

// Asks for what some node of the table was recorded in, and now and then for other things.
void ask_for_surroundings(const MotionTable& table, std::vector<SearchStep>& steps, Draw& draw) {
  const std::vector<Surroundings> recorded = recorded_surroundings(table);
  for (SearchStep& step : steps) {
    step.surroundings = recorded[static_cast<std::size_t>(draw.below(table.node_count()))];
    if (draw.chance(0.3)) {
      step.surroundings.duration_s = 0.3 * draw.unit();
      step.surroundings.next = -1;
      step.surroundings.after.fill(-1);
    }
  }
}

TEST(ContextFit, search_with_it_equals_the_plain_recursion) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    const MotionTable table = test::random_table(some_shape(draw), draw);
    const CostWeights weights = context_weights(draw);
    std::vector<SearchStep> steps = test::random_steps(table, 1 + draw.below(10), draw);
    ask_for_surroundings(table, steps, draw);
    ContextFit fit(table, weights);
    const NodeClasses classes(table);
    const test::PlainRecursion judge(table, weights, [&](const SearchStep& step, NodeIndex node) {
      return fit.counts() ? fit.fit(fit.wish(step, classes), node, false).sum() : 0.0;
    });
    const NodePath judged = judge.solve(steps);
    ViterbiSearch search(table, weights);
    for (const int threads : {1, 2}) {
      const SearchResult found = search.solve(steps, {.threads = threads, .runners_up = 2});
      ASSERT_EQ(found.path.cost, judged.cost);
      ASSERT_EQ(found.path.nodes, judged.nodes);
    }
  }
}

// The phoneme that is said in a table's sentence at a time, by looking at every node.
std::int32_t said(const MotionTable& table, std::int32_t sentence, double time_s) {
  for (const MotionNode& node : table.nodes) {
    const double begin_s = static_cast<double>(node.first_frame) / table.rate_hz;
    if (node.sentence == sentence && begin_s <= time_s &&
        time_s < begin_s + node.frame_count / table.rate_hz) {
      return node.phoneme;
    }
  }
  return 0;
}

TEST(ContextFit, surroundings_are_what_is_said_around) {
  Draw draw(1);
  test::TableShape shape;
  shape.sentences = 12;
  const MotionTable table = test::random_table(shape, draw);
  const std::vector<Surroundings> surroundings = recorded_surroundings(table);
  for (std::size_t i = 0; i < table.nodes.size(); ++i) {
    const MotionNode& node = table.nodes[i];
    const double begin_s = static_cast<double>(node.first_frame) / table.rate_hz;
    const double end_s = begin_s + node.frame_count / table.rate_hz;
    EXPECT_NEAR(surroundings[i].duration_s, end_s - begin_s, 1e-9);
    for (std::size_t j = 0; j < Surroundings::kLooks; ++j) {
      const double away_s = 0.015 + 0.03 * static_cast<double>(j);
      EXPECT_EQ(surroundings[i].before[j], said(table, node.sentence, begin_s - away_s));
      EXPECT_EQ(surroundings[i].after[j], said(table, node.sentence, end_s + away_s));
    }
  }
}

TEST(ContextFit, neighbours_end_at_a_pause) {
  const std::vector<SpokenPhoneme> utterance = {
      {0.0, 0.1, 1}, {0.1, 0.3, 2}, {0.3, 0.4, 3}, {0.6, 0.7, 4}};
  const Surroundings second = surroundings_of(utterance, 1, 1e-6);
  EXPECT_EQ(std::tuple(second.second_previous, second.previous, second.next, second.second_next),
            std::tuple(0, 1, 3, 0));
  EXPECT_NEAR(second.position, 0.5, 1e-12); // middle at 0.2 of a phrase of 0.4 s
  const Surroundings last = surroundings_of(utterance, 3, 1e-6);
  EXPECT_EQ(last.previous, 0);
  EXPECT_NEAR(last.position, 0.5, 1e-12);
}

// The terms by their definitions, in channels and without vectors.
struct PlainFit {
  const MotionTable& table;
  std::vector<Surroundings> surroundings = recorded_surroundings(table);

  double share(int group) const {
    const double lips = static_cast<double>(table.layout.groups_in(Region::lips).size());
    const double rest = table.layout.group_count() - lips;
    const bool lip = table.layout.groups[static_cast<std::size_t>(group)].in(Region::lips);
    return lip ? 1.0 / lips : (lips == 0.0 ? 1.0 : 0.25) / rest;
  }
  double square(const Eigen::VectorXd& coefficients) const {
    const Eigen::VectorXd channels = table.pca.basis * coefficients;
    const int axes = table.layout.channels_per_group();
    double sum = 0.0;
    for (int group = 0; group < table.layout.group_count(); ++group) {
      sum += share(group) * channels.segment(axes * group, axes).squaredNorm();
    }
    return sum;
  }
  double variance() const {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < table.pca.dimension_count(); ++k) {
      sum += table.pca.variance[k] * square(Eigen::VectorXd::Unit(table.pca.dimension_count(), k));
    }
    return sum;
  }
  // Five frames over the node's duration.
  FrameMatrixD samples(NodeIndex node) const {
    const FrameMatrixD frames = table.node_frames(node).cast<double>();
    FrameMatrixD result(5, frames.cols());
    for (int s = 0; s < 5; ++s) {
      const double u = s / 4.0 * static_cast<double>(frames.rows() - 1);
      const auto below = static_cast<Eigen::Index>(std::floor(u));
      const Eigen::Index above = std::min(below + 1, frames.rows() - 1);
      result.row(s) = frames.row(below) +
                      (u - static_cast<double>(below)) * (frames.row(above) - frames.row(below));
    }
    return result;
  }
  double target(const FrameMatrixD& expected, NodeIndex node) const {
    const FrameMatrixD own = samples(node);
    double sum = 0.0;
    for (int s = 0; s < 5; ++s) {
      sum += square((own.row(s) - expected.row(s)).transpose());
    }
    return sum / 5.0 / variance();
  }
  Eigen::VectorXd mean_pose(std::int32_t phoneme) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(table.pca.dimension_count());
    double count = 0.0;
    for (const MotionNode& node : table.nodes) {
      if (node.phoneme == phoneme) {
        sum += table.coefficients.row(node.first_frame + node.frame_count / 2)
                   .cast<double>()
                   .transpose();
        count += 1.0;
      }
    }
    return count == 0.0 ? Eigen::VectorXd() : Eigen::VectorXd(sum / count);
  }
  double distance(std::int32_t a, std::int32_t b) const {
    const Eigen::VectorXd left = mean_pose(a);
    const Eigen::VectorXd right = mean_pose(b);
    return left.size() == 0 || right.size() == 0 ? -1.0 : std::sqrt(square(left - right));
  }
  double dissimilarity(std::int32_t a, std::int32_t b) const {
    if (a == b && a >= 0) {
      return 0.0;
    }
    const double own = a < 0 || b < 0 ? -1.0 : distance(a, b);
    double sum = 0.0;
    double pairs = 0.0;
    for (std::int32_t p = 0; p < static_cast<std::int32_t>(table.phonemes.size()); ++p) {
      for (std::int32_t q = 0; q < p; ++q) {
        if (const double other = distance(p, q); other >= 0.0) {
          sum += other;
          pairs += 1.0;
        }
      }
    }
    return own < 0.0 ? 1.0 : own * pairs / sum;
  }
  double context(const Surroundings& asked, NodeIndex node) const {
    const Surroundings& own = surroundings[static_cast<std::size_t>(node)];
    double sum = 0.0;
    double weights = 0.0;
    for (std::size_t j = 0; j < Surroundings::kLooks; ++j) {
      const double weight = std::pow(0.78, static_cast<double>(j));
      weights += weight;
      sum += weight * (dissimilarity(asked.before[j], own.before[j]) +
                       dissimilarity(asked.after[j], own.after[j]));
    }
    return sum / weights;
  }
};

TEST(ContextFit, terms_are_those_of_their_definitions) {
  int recorded_just_so = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    test::TableShape shape = some_shape(draw);
    shape.sentences += 4;
    const MotionTable table = test::random_table(shape, draw);
    CostWeights weights = test::random_weights(draw);
    weights.pnt = 100.0;
    weights.target = 0.5;
    weights.context = 0.7;
    weights.duration = 0.3;
    weights.position = 0.2;
    ContextFit fit(table, weights);
    const PlainFit plain{table};
    std::vector<SearchStep> steps = test::random_steps(table, 6, draw, 0.0, 0.0);
    ask_for_surroundings(table, steps, draw);
    const NodeClasses classes(table);
    for (const SearchStep& step : steps) {
      const ContextFit::Wish wish = fit.wish(step, classes);
      const FrameMatrixD expected = fit.expected_frames(step, classes);
      for (int i = 0; i < 8; ++i) {
        const NodeIndex node = draw.below(table.node_count());
        const Surroundings& own = plain.surroundings[static_cast<std::size_t>(node)];
        const FitCost cost = fit.fit(wish, node, false);
        const bool just_so =
            own.before == step.surroundings.before && own.after == step.surroundings.after &&
            std::abs(own.duration_s - step.surroundings.duration_s) < 0.5 / table.rate_hz;
        if (just_so) {
          EXPECT_EQ(cost.target, 0.0);
          ++recorded_just_so;
        } else if (expected.rows() > 0) {
          const double target = plain.target(expected, node);
          EXPECT_NEAR(cost.target, 50.0 * target, 1e-4 * (1.0 + 50.0 * target));
        }
        EXPECT_NEAR(cost.context, 70.0 * plain.context(step.surroundings, node), 0.01);
        EXPECT_NEAR(cost.duration,
                    30.0 * std::abs(own.duration_s - step.surroundings.duration_s) /
                        (0.5 * (own.duration_s + step.surroundings.duration_s)),
                    1e-9);
        EXPECT_NEAR(cost.position, 20.0 * std::abs(own.position - step.surroundings.position),
                    1e-9);
      }
      const FitCost silent = fit.fit(fit.wish({.is_silence = true}, classes), 0, false);
      EXPECT_EQ(silent.sum(), 0.0);
    }
  }
  EXPECT_GT(recorded_just_so, 10);
}

TEST(ContextFit, a_node_costs_the_same_whether_it_was_made_ready_or_not) {
  Draw draw(3);
  const MotionTable table = test::random_table(some_shape(draw), draw);
  CostWeights weights = test::random_weights(draw);
  weights.target = 1.0;
  weights.pnt = 10.0;
  ContextFit fit(table, weights);
  const ContextFit::Wish wish = fit.wish({.phoneme = 1, .viseme = 1}, NodeClasses(table));
  fit.ensure(test::all_nodes(table));
  for (const NodeIndex node : test::all_nodes(table)) {
    EXPECT_EQ(fit.fit(wish, node, true).sum(), fit.fit(wish, node, false).sum());
  }
}

TEST(ExpectedMotion, examples_all_alike_are_drawn_towards_nothing_stage_by_stage) {
  const std::vector<float> example = {2.0f, -4.0f};
  const std::vector<const float*> records(24, example.data());
  const std::vector<PhonemeContext> contexts(24);
  const ExpectedMotion expected(records, 2, contexts);
  // Every stage has one part of 24: the residual shrinks to 8 / 32 of itself nine times.
  const double share = 1.0 - std::pow(0.25, 9.0);
  EXPECT_NEAR(expected.in({})[0], 2.0 * share, 1e-6);
  EXPECT_NEAR(expected.in({})[1], -4.0 * share, 1e-6);
}

TEST(ExpectedMotion, a_context_that_was_never_recorded_takes_what_wider_ones_say) {
  const float high = 10.0f;
  const float low = -10.0f;
  std::vector<const float*> records;
  std::vector<PhonemeContext> contexts;
  for (int i = 0; i < 400; ++i) { // after phoneme 1 high, after phoneme 2 low
    records.push_back(i % 2 == 0 ? &high : &low);
    PhonemeContext context;
    context.surroundings.previous = i % 2 == 0 ? 1 : 2;
    context.surroundings.next = 3;
    contexts.push_back(context);
  }
  const ExpectedMotion expected(records, 1, contexts);
  PhonemeContext asked = contexts[0];
  EXPECT_NEAR(expected.in(asked)[0], 10.0, 0.01);
  asked.surroundings.next = 4; // never recorded: the neighbour before still tells
  EXPECT_NEAR(expected.in(asked)[0], 10.0, 0.5);
  asked.surroundings.previous = 5; // neither: the mean of all
  EXPECT_NEAR(expected.in(asked)[0], 0.0, 0.01);
}

} // namespace
} // namespace phonomime
