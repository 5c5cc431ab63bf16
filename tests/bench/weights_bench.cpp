// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/bounded_least_squares.h"
#include "synth/retarget/weight_solver.h"
#include "tests/bench/compare.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <benchmark/benchmark.h>

namespace phonomime {
namespace {

constexpr Eigen::Index kShapes = 53;
constexpr Eigen::Index kRows = 3 * 91;
constexpr Eigen::Index kFrames = 3000;

// Six frames a syllable of slowly moving weights, half of them 0, on shapes of a few markers each
// that overlap, and noise on the markers.
struct Performance {
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(kRows, kShapes);
  FrameMatrixD frames;

  Performance() {
    std::mt19937_64 draw(5);
    std::normal_distribution<double> number;
    for (Eigen::Index i = 0; i < kShapes; ++i) {
      for (Eigen::Index row = 0; row < kRows; ++row) {
        const double distance =
            (static_cast<double>(row) / kRows - static_cast<double>(i) / kShapes) * 8.0;
        shapes(row, i) = number(draw) * 4.0 * std::exp(-0.5 * distance * distance);
      }
    }
    const FrameMatrixD weights =
        FrameMatrixD::NullaryExpr(kFrames, kShapes, [](Eigen::Index t, Eigen::Index i) {
          const auto phase = static_cast<double>(t * (3 + i % 7) + 50 * i);
          return std::max(0.0, std::sin(0.012 * phase));
        });
    frames = weights * shapes.transpose();
    frames += 0.3 * FrameMatrixD::NullaryExpr(kFrames, kRows, [&] { return number(draw); });
  }
};

// The optimality conditions hold in every frame.
void verify_optimal(const Performance& performance, const FrameMatrixD& weights) {
  const FrameMatrixD slopes =
      (weights * performance.shapes.transpose() - performance.frames) * performance.shapes;
  const double tolerance = 1e-9 * slopes.cwiseAbs().maxCoeff();
  bool right = true;
  for (Eigen::Index k = 0; k < slopes.size(); ++k) {
    const double weight = weights.data()[k];
    const double slope = slopes.data()[k];
    right &= weight >= 0.0 && weight <= 1.0 && (weight == 0.0 || slope < tolerance) &&
             (weight == 1.0 || slope > -tolerance);
  }
  bench::verify(right, "weights are not the least");
}

FrameMatrixD solved_cold(const Performance& performance) {
  const Eigen::MatrixXd gram = performance.shapes.transpose() * performance.shapes;
  const FrameMatrixD right = performance.frames * performance.shapes;
  BoundedLeastSquares solver(gram, Eigen::VectorXd::Zero(kShapes), Eigen::VectorXd::Ones(kShapes));
  FrameMatrixD weights(kFrames, kShapes);
  for (Eigen::Index t = 0; t < kFrames; ++t) {
    solver.start_cold();
    weights.row(t) = solver.solve(right.row(t).transpose()).transpose();
  }
  return weights;
}

// 53 shapes on 91 markers, one core: warm over a sequence against every frame from nothing.
void weights_warm_against_cold(benchmark::State& state) {
  const Performance performance;
  const WeightSolver solver(performance.shapes, {}, {});
  const FrameMatrixD weights = solver.solve(performance.frames);
  verify_optimal(performance, weights);
  bench::verify(weights == solved_cold(performance), "warm and cold weights differ");
  std::vector<double> times_s;
  bench::compare(
      state,
      [&] {
        times_s.push_back(bench::seconds([&] { return solver.solve(performance.frames).sum(); }));
        return times_s.size();
      },
      [&] { return solved_cold(performance).sum(); });
  state.counters["frames/s"] = kFrames / bench::median(times_s);
}
BENCHMARK(weights_warm_against_cold)->Iterations(5)->UseManualTime()->Unit(benchmark::kMillisecond);

} // namespace
} // namespace phonomime
