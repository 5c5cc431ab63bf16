// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/frame_times.h"
#include "synth/concat/concatenate.h"
#include "synth/concat/resample.h"
#include "tests/bench/compare.h"
#include "tests/synth/concat/plain_concatenate.h"
#include "tests/synth/concat/synthetic_table.h"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

namespace phonomime {
namespace {

constexpr int kDimensions = 25;

// Speech of about ten phonemes a second with a pause every twelve, over a table of random motion.
struct Speech {
  MotionTable table;
  std::vector<ConcatStep> steps;
  explicit Speech(int length_s) {
    std::mt19937 random(41);
    table = test::random_table(random, 50, 30, 12, kDimensions);
    std::uniform_int_distribution<NodeIndex> any(0, table.node_count() - 1);
    std::uniform_int_distribution<int> frames(2, 18);
    std::vector<std::pair<NodeIndex, int>> parts;
    for (int i = 0; i < 10 * length_s; ++i) {
      parts.emplace_back(i % 12 == 0 ? kNoNode : any(random), frames(random));
    }
    steps = test::steps_of(table, parts);
  }
};

// Every output sample as a sum over every frame of the motion, continued far beyond both ends.
FrameMatrixD plain_resample(const CoefficientMotion& motion, double fps, double end_s) {
  const LowPassKernel kernel(motion.rate_hz, fps, kOutputLowPass);
  const Eigen::Index n = motion.coefficients.rows();
  const Eigen::Index margin = std::min(n - 1, Eigen::Index{64});
  FrameMatrixD extended(n + 2 * margin, kDimensions);
  extended.middleRows(margin, n) = motion.coefficients;
  for (Eigen::Index i = 1; i <= margin; ++i) {
    extended.row(margin - i) = 2.0 * motion.coefficients.row(0) - motion.coefficients.row(i);
    extended.row(margin + n - 1 + i) =
        2.0 * motion.coefficients.row(n - 1) - motion.coefficients.row(n - 1 - i);
  }
  Eigen::MatrixXd weights(frame_count_to(end_s, fps), extended.rows());
  for (Eigen::Index k = 0; k < weights.rows(); ++k) {
    const double u =
        std::min(static_cast<double>(k) * motion.rate_hz / fps, static_cast<double>(n - 1));
    for (Eigen::Index i = 0; i < weights.cols(); ++i) {
      weights(k, i) = kernel(static_cast<double>(i - margin) - u);
    }
    weights.row(k) /= weights.row(k).sum();
  }
  return weights * extended;
}

void concatenate_against_plain(benchmark::State& state) {
  const Speech speech(static_cast<int>(state.range(0)));
  const auto ours = [&] { return concatenate(speech.table, speech.steps).coefficients; };
  const auto plain = [&] { return test::plain_concatenate(speech.table, speech.steps, {}); };
  bench::verify((ours() - plain()).cwiseAbs().maxCoeff() < 1e-10, "concatenate");
  bench::compare(state, ours, plain);
}
BENCHMARK(concatenate_against_plain)
    ->Arg(6)
    ->Arg(60)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void resample_against_plain(benchmark::State& state) {
  const Speech speech(static_cast<int>(state.range(0)));
  const CoefficientMotion motion = concatenate(speech.table, speech.steps);
  const double end_s = speech.steps.back().end_s;
  const auto ours = [&] { return resample_motion(motion, 30.0, end_s).coefficients; };
  const auto plain = [&] { return plain_resample(motion, 30.0, end_s); };
  bench::verify((ours() - plain()).cwiseAbs().maxCoeff() < 1e-10, "resample_motion");
  bench::compare(state, ours, plain);
}
BENCHMARK(resample_against_plain)->Arg(6)->Arg(60)->UseManualTime()->Unit(benchmark::kMillisecond);

} // namespace
} // namespace phonomime
