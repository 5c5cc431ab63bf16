// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/pca.h"

#include "db/types/errors.h"

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include <random>

namespace phonomime {
namespace {

// Frames that lie in five directions about a far mean, with a little noise.
FrameMatrix make_frames(Eigen::Index count, unsigned seed) {
  std::mt19937 directions(99);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd mixing(5, 30);
  for (double& value : mixing.reshaped()) {
    value = normal(directions);
  }
  FrameMatrix frames(count, 30);
  for (Eigen::Index k = 0; k < count; ++k) {
    Eigen::RowVectorXd weights(5);
    for (int i = 0; i < 5; ++i) {
      weights(i) = normal(random) * (6 - i);
    }
    Eigen::RowVectorXd frame = weights * mixing;
    for (double& value : frame.reshaped()) {
      value += 500.0 + 0.01 * normal(random);
    }
    frames.row(k) = frame.cast<float>();
  }
  return frames;
}

FrameStatistics gather(const std::vector<FrameMatrix>& sentences, int threads) {
  CovarianceAccumulator accumulator(30, threads);
  for (const FrameMatrix& frames : sentences) {
    accumulator.add(frames, std::vector<std::uint8_t>(static_cast<std::size_t>(frames.rows()), 0));
  }
  return accumulator.finish();
}

TEST(Pca, IsTheSingularValueDecompositionOfTheCentredFrames) {
  const FrameMatrix frames = make_frames(9000, 1); // more than one round of blocks
  const PcaModel model = fit_pca(gather({frames}, 2), {.dimensions = 5, .share = {}});
  const Eigen::MatrixXd all = frames.cast<double>();
  const Eigen::MatrixXd centred = all.rowwise() - all.colwise().mean();
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(centred, Eigen::ComputeThinV);
  EXPECT_LT((model.mean.transpose() - all.colwise().mean()).norm(), 1e-9);
  EXPECT_LT((model.basis.transpose() * model.basis - Eigen::MatrixXd::Identity(5, 5)).norm(),
            1e-10);
  EXPECT_NEAR(model.total_variance, centred.squaredNorm() / 9000.0, 1e-6);
  for (int d = 0; d < 5; ++d) {
    const double variance = std::pow(svd.singularValues()(d), 2) / 9000.0;
    EXPECT_NEAR(model.variance(d), variance, 1e-8 * variance) << d;
    EXPECT_NEAR(std::abs(model.basis.col(d).dot(svd.matrixV().col(d))), 1.0, 1e-9) << d;
    Eigen::Index largest = 0;
    model.basis.col(d).cwiseAbs().maxCoeff(&largest);
    EXPECT_GT(model.basis(largest, d), 0.0) << d;
  }
}

TEST(Pca, GivesTheSameBytesAtAnyThreadCount) {
  const std::vector<FrameMatrix> sentences{make_frames(5000, 1), make_frames(333, 2),
                                           make_frames(6001, 3)};
  const FrameStatistics one = gather(sentences, 1);
  for (const int threads : {2, 3, 8}) {
    const FrameStatistics many = gather(sentences, threads);
    EXPECT_EQ(one.mean, many.mean);
    EXPECT_EQ(one.covariance, many.covariance);
  }
}

TEST(Pca, FramesLeftOutDoNotCount) {
  FrameMatrix frames = make_frames(1000, 4);
  const FrameStatistics without = gather({frames.topRows(700)}, 1);
  frames.bottomRows(300).setConstant(1e6f);
  std::vector<std::uint8_t> leave_out(1000, 0);
  std::fill(leave_out.begin() + 700, leave_out.end(), std::uint8_t{1});
  CovarianceAccumulator accumulator(30, 1);
  accumulator.add(frames, leave_out);
  const FrameStatistics statistics = accumulator.finish();
  EXPECT_EQ(statistics.frames, 700);
  EXPECT_EQ(statistics.left_out, 300);
  EXPECT_EQ(statistics.covariance, without.covariance);
}

TEST(Pca, TakesTheLeastDimensionsThatExplainAShare) {
  const FrameStatistics statistics = gather({make_frames(2000, 5)}, 1);
  const PcaModel all = fit_pca(statistics, {.dimensions = 1000, .share = {}});
  EXPECT_EQ(all.dimension_count(), 30);
  for (const double share : {0.3, 0.9, 0.99, 1.0}) {
    const PcaModel model = fit_pca(statistics, {.dimensions = 25, .share = share});
    const Eigen::Index n = model.dimension_count();
    EXPECT_GE(all.variance.head(n).sum(), share * all.total_variance * (1.0 - 1e-12));
    if (n > 1) {
      EXPECT_LT(all.variance.head(n - 1).sum(), share * all.total_variance);
    }
  }
}

TEST(Pca, NoFrameIsAnError) {
  EXPECT_THROW(fit_pca(gather({}, 1), {}), InputError);
}

} // namespace
} // namespace phonomime
