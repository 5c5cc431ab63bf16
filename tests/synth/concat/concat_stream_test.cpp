// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/concat_stream.h"

#include "db/types/errors.h"
#include "synth/concat/append_frames.h"
#include "synth/concat/resample.h"
#include "tests/synth/concat/synthetic_table.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::random_table;

// A path at any times, with pauses short and long, shown pauses, captured runs and phonemes shorter
// than a frame.
std::vector<ConcatStep> random_path(const MotionTable& table, std::mt19937& random, int length) {
  std::uniform_int_distribution<NodeIndex> any(0, table.node_count() - 1);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::vector<ConcatStep> steps;
  double end_s = 0.0;
  for (int i = 0; i < length; ++i) {
    ConcatStep step;
    step.start_s = end_s;
    step.is_silence = part(random) < 0.25;
    step.show_node = step.is_silence && part(random) < 0.2;
    const bool after_node = !steps.empty() && steps.back().shows();
    step.node = after_node && part(random) < 0.4 ? steps.back().node + 1 : any(random);
    step.node = std::min(step.node, table.node_count() - 1);
    step.captured =
        after_node && step.shows() &&
        table.nodes[static_cast<std::size_t>(step.node)].predecessor == steps.back().node;
    const bool was_short = !steps.empty() && steps.back().end_s - steps.back().start_s < 0.03;
    const double kind = part(random);
    end_s += kind < 0.15 && !was_short ? 0.008 * part(random)
             : step.is_silence         ? 0.6 * part(random) * part(random) + 0.05
                                       : 0.03 + 0.12 * part(random);
    if (kind > 0.6) {
      end_s = std::round(end_s * 100.0) / 100.0 + 0.01; // on a frame
    }
    step.end_s = end_s;
    steps.push_back(step);
  }
  return steps;
}

FrameMatrixD offline(const MotionTable& table, const std::vector<ConcatStep>& steps, double fps,
                     const ConcatOptions& options) {
  return resample_motion(concatenate(table, steps, options), fps, steps.back().end_s).coefficients;
}

// With the times of up to `ahead` rows told before a step's node.
FrameMatrixD streamed(const MotionTable& table, const std::vector<ConcatStep>& steps, double fps,
                      const ConcatOptions& options, std::function<std::size_t()> ahead) {
  ConcatStream stream(table, fps, options);
  FrameMatrixD frames(0, table.coefficients.cols());
  std::size_t announced = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::size_t until = std::min(steps.size(), i + ahead());
    for (announced = std::max(announced, i); announced < until; ++announced) {
      const ConcatStep& row = steps[announced];
      stream.announce({row.start_s, row.end_s, row.shows()});
    }
    append_frames(frames, stream.push(steps[i]));
    announced = std::max(announced, i + 1);
  }
  append_frames(frames, stream.finish());
  return frames;
}

TEST(ConcatStream, GivesTheFramesOfTheWholePathToTheBit) {
  std::mt19937 random(21);
  const std::vector<double> rates = {30.0, 100.0, 25.0, 60.0, 29.97, 120.0, 240.0, 7.0, 1.0};
  for (int round = 0; round < 1500; ++round) {
    const MotionTable table = random_table(random, 4, 6);
    const std::vector<ConcatStep> steps = random_path(table, random, 1 + round % 37);
    ConcatOptions options;
    options.silence.fill = static_cast<SilenceFill>(round % 3);
    options.silence.rest_at_ends = round % 5 != 0;
    options.silence.rest_within_s = round % 7 == 0 ? 0.0 : 0.2;
    options.smoothing_half_window =
        std::vector{3, 0, 1, 8, 100}[static_cast<std::size_t>(round % 4)];
    const double fps = rates[static_cast<std::size_t>(round) % rates.size()];
    const FrameMatrixD expected = offline(table, steps, fps, options);
    std::uniform_int_distribution<std::size_t> some(0, 6);
    for (const auto& ahead : std::vector<std::function<std::size_t()>>{
             [] { return 0; }, [] { return 4; }, [&] { return some(random); }}) {
      const FrameMatrixD got = streamed(table, steps, fps, options, ahead);
      ASSERT_EQ(got.rows(), expected.rows()) << round;
      ASSERT_TRUE(got == expected) << round;
    }
  }
}

TEST(ConcatStream, GivesFramesLongBeforeTheEnd) {
  std::mt19937 random(22);
  const MotionTable table = random_table(random, 20, 8);
  ConcatStream stream(table, 30.0);
  Eigen::Index frames = 0;
  for (NodeIndex node = 0; node < 100; ++node) {
    const double start_s = 0.08 * node;
    frames += stream
                  .push({.start_s = start_s,
                         .end_s = 0.08 * (node + 1),
                         .node = node,
                         .captured = node % 8 > 0})
                  .rows();
    // Its own row and the next are still open, and so is what the kernel sees: 0.2 s.
    EXPECT_GT(static_cast<double>(frames), 30.0 * (start_s - 0.08 - 0.2) - 1.0) << node;
  }
}

TEST(ConcatStream, RestsAtOnceBeforeItSpeaks) {
  std::mt19937 random(23);
  const MotionTable table = random_table(random, 2, 4);
  ConcatStream stream(table, 100.0);
  stream.announce({0.0, 60.0, false});
  stream.announce({60.0, 60.1, true});
  const FrameMatrixD frames = stream.push({.is_silence = true, .end_s = 60.0});
  EXPECT_EQ(frames.rows(), 6000 - 21);
  const Eigen::RowVectorXd rest = table.pca.project(table.reference_pose).transpose();
  EXPECT_TRUE(frames == rest.replicate(frames.rows(), 1));
}

// A step costs the same after an hour of speech as at its beginning.
TEST(ConcatStream, WorkOfAStepDoesNotGrow) {
  std::mt19937 random(24);
  const MotionTable table = random_table(random, 20, 8, 12, 25);
  ConcatStream stream(table, 30.0);
  std::uniform_int_distribution<NodeIndex> any(0, table.node_count() - 1);
  const auto time_of = [&](int first, int count) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = first; i < first + count; ++i) {
      const bool pause = i % 12 == 0;
      stream.push({.is_silence = pause,
                   .start_s = 0.08 * i,
                   .end_s = 0.08 * (i + 1),
                   .node = pause ? kNoNode : any(random)});
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  constexpr int kSteps = 3000;
  double early_s = time_of(0, kSteps);
  early_s = std::min(early_s, time_of(kSteps, kSteps));
  double late_s = 0.0;
  for (int part = 2; part < 15; ++part) {
    const double part_s = time_of(part * kSteps, kSteps);
    late_s = part == 2 ? part_s : std::min(late_s, part_s);
  }
  EXPECT_LT(late_s, 3.0 * early_s);
}

TEST(ConcatStream, RefusesWhatDoesNotFollow) {
  std::mt19937 random(25);
  const MotionTable table = random_table(random, 2, 4);
  ConcatStream empty(table, 30.0);
  EXPECT_THROW(empty.finish(), InternalError);
  empty.push({.end_s = 1e-12, .node = 0}); // too short to have any frame but the one at its end
  EXPECT_EQ(empty.finish().rows(), 1);
  ConcatStream stream(table, 30.0);
  stream.push({.start_s = 0.0, .end_s = 0.1, .node = 0});
  EXPECT_THROW(stream.push({.start_s = 0.2, .end_s = 0.3, .node = 1}), InternalError);
  EXPECT_THROW(stream.announce({0.3, 0.4, true}), InternalError);
  EXPECT_THROW(stream.push({.start_s = 0.1, .end_s = 0.2, .node = 99}), InternalError);
  EXPECT_THROW(ConcatStream(table, 0.0), InternalError);
  EXPECT_THROW(ConcatStream(table, 30.0, {.smoothing_half_window = -1}), InternalError);
  EXPECT_THROW(stream.push({.start_s = 0.1, .end_s = 2e5, .node = 1}), InputError);
}

} // namespace
} // namespace phonomime
