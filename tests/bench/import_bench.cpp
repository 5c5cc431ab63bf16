// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/pca.h"
#include "tests/bench/compare.h"
#include "tests/synth/search/random_tables.h"

#include <Eigen/Eigenvalues>
#include <benchmark/benchmark.h>

namespace phonomime {
namespace {

// 273 channels with 25 directions of motion and a little noise, as a face has.
FrameMatrix face_like_frames(int count) {
  constexpr int kChannels = 273;
  constexpr int kDirections = 25;
  test::Draw draw(3);
  Eigen::MatrixXd directions(kDirections, kChannels);
  for (double& value : directions.reshaped()) {
    value = draw.symmetric();
  }
  Eigen::MatrixXd amounts(count, kDirections);
  for (double& value : amounts.reshaped()) {
    value = draw.symmetric();
  }
  FrameMatrix frames = (amounts * directions).cast<float>();
  for (float& value : frames.reshaped()) {
    value += static_cast<float>(0.01 * draw.symmetric());
  }
  return frames;
}

PcaModel blocked_pca(const FrameMatrix& frames) {
  CovarianceAccumulator statistics(frames.cols(), 2);
  statistics.add(frames, std::vector<std::uint8_t>(static_cast<std::size_t>(frames.rows()), 0));
  return fit_pca(statistics.finish(), {});
}

// Covariance entry by entry, all eigenvectors.
Eigen::VectorXd plain_variances(const FrameMatrix& frames) {
  const Eigen::RowVectorXd mean = frames.cast<double>().colwise().mean();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(frames.cols(), frames.cols());
  for (Eigen::Index f = 0; f < frames.rows(); ++f) {
    const Eigen::RowVectorXd offset = frames.row(f).cast<double>() - mean;
    for (Eigen::Index a = 0; a < frames.cols(); ++a) {
      for (Eigen::Index b = 0; b < frames.cols(); ++b) {
        covariance(a, b) += offset[a] * offset[b];
      }
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance /
                                                              static_cast<double>(frames.rows()));
  return solver.eigenvalues().reverse().head(25);
}

void pca_against_plain_covariance(benchmark::State& state) {
  const FrameMatrix frames = face_like_frames(4000);
  const Eigen::VectorXd ours = blocked_pca(frames).variance;
  const Eigen::VectorXd plain = plain_variances(frames);
  bench::verify((ours - plain).norm() < 1e-9 * plain.norm(), "the variances are not right");
  bench::compare(
      state, [&] { return blocked_pca(frames).total_variance; },
      [&] { return plain_variances(frames).sum(); });
}
BENCHMARK(pca_against_plain_covariance)
    ->Iterations(3)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace phonomime
