// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/pca.h"
#include "db/import/readers.h"
#include "tests/bench/compare.h"
#include "tests/db/import/readers/c3d_writer.h"
#include "tests/synth/search/random_tables.h"

#include <cmath>
#include <limits>
#include <sstream>

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

// 91 markers, some of them missing at times.
test::C3dFile face_like_recording(int frames) {
  test::C3dFile file;
  file.floats = true;
  file.frames = frames;
  file.labels.clear();
  for (int marker = 0; marker < 91; ++marker) {
    file.labels.push_back("lm" + std::to_string(marker));
  }
  file.point = [](int frame, int point) {
    const double turn = 0.01 * frame + point;
    return test::C3dFile::Point{20.0 * std::sin(turn), 30.0 * std::cos(turn), 0.5 * point,
                                (frame + point) % 97 == 0 ? -1.0 : 0.0};
  };
  return file;
}

// Number by number from a stream.
FrameMatrix plain_points(const std::string& bytes, Eigen::Index frames, Eigen::Index points) {
  std::istringstream stream(bytes);
  std::uint16_t first_block = 0;
  stream.seekg(16);
  stream.read(reinterpret_cast<char*>(&first_block), sizeof first_block);
  stream.seekg((first_block - 1) * 512);
  FrameMatrix result(frames, 3 * points);
  for (Eigen::Index frame = 0; frame < frames; ++frame) {
    for (Eigen::Index point = 0; point < points; ++point) {
      float numbers[4];
      for (float& number : numbers) {
        stream.read(reinterpret_cast<char*>(&number), sizeof number);
      }
      for (int axis = 0; axis < 3; ++axis) {
        result(frame, 3 * point + axis) =
            numbers[3] < 0.0f ? std::numeric_limits<float>::quiet_NaN() : numbers[axis];
      }
    }
  }
  return result;
}

void c3d_against_a_stream(benchmark::State& state) {
  const test::C3dFile file = face_like_recording(2000);
  const std::string bytes = test::write_c3d(file);
  const auto ours = [&] { return parse_c3d(bytes, "made.c3d").frames; };
  const auto plain = [&] { return plain_points(bytes, file.frames, std::ssize(file.labels)); };
  const FrameMatrix read = ours();
  const FrameMatrix expected = plain();
  bench::verify(
      read.rows() == expected.rows() && read.cols() == expected.cols() &&
          (read.array() == expected.array() || (read.array().isNaN() && expected.array().isNaN()))
              .all(),
      "the points are not those of the file");
  bench::compare(state, ours, plain);
}
BENCHMARK(c3d_against_a_stream)->Iterations(10)->UseManualTime()->Unit(benchmark::kMillisecond);

} // namespace
} // namespace phonomime
