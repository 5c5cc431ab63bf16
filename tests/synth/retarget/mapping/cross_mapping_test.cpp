// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/cross_mapping.h"
#include "tests/support/expect_error.h"
#include "tests/synth/retarget/mapping/made_pairs.h"

#include <limits>

#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// 30 channels of which a PCA keeps 8 dimensions; the weights follow the first three.
struct Scene {
  PcaModel pca = made_pca(30, 8, 1);

  static FrameMatrixD weights_of(const FrameMatrixD& coefficients) {
    FrameMatrixD weights(coefficients.rows(), 2);
    weights.col(0) =
        (0.5 + coefficients.col(0).array() * 0.05 + coefficients.col(1).array() * 0.03);
    weights.col(1) = coefficients.col(2).array().square() * 0.012;
    return weights.cwiseMax(0.0).cwiseMin(1.0);
  }
  FrameMatrixD channels_of(const FrameMatrixD& coefficients) const {
    return (coefficients * pca.basis.transpose()).rowwise() + pca.mean.transpose();
  }
  ReferencePairs pairs(Eigen::Index count) const {
    const FrameMatrixD coefficients = made_matrix(count, 8, 8.0, 2);
    return {.shapes = {"jawOpen", "smile"},
            .channels = channels_of(coefficients),
            .weights = weights_of(coefficients)};
  }
};

double rms(const FrameMatrixD& difference) {
  return std::sqrt(difference.array().square().mean());
}

} // namespace

TEST(CrossMapping, MapsWhatItHasNotSeen) {
  const Scene scene;
  const CrossMapping mapping(scene.pca, scene.pairs(120), {.dimensions = 3});
  const FrameMatrixD coefficients = made_matrix(400, 8, 6.0, 3);
  const FrameMatrixD found = mapping.weights(scene.channels_of(coefficients));
  EXPECT_LT(rms(found - Scene::weights_of(coefficients)), 0.02);
  EXPECT_GE(found.minCoeff(), 0.0);
  EXPECT_LE(found.maxCoeff(), 1.0);
}

TEST(CrossMapping, CrossValidationFindsTheDimensionsThatMatter) {
  const Scene scene;
  ReferencePairs pairs = scene.pairs(120);
  pairs.weights += made_matrix(120, 2, 0.04, 5); // no hand is steady
  const CrossMapping mapping(scene.pca, pairs, {.dimensions = 0});
  EXPECT_EQ(mapping.dimensions(), 3);
  ASSERT_EQ(mapping.trials().size(), 8U);
  EXPECT_LT(mapping.trials()[2].weight_rms, 0.6 * mapping.trials()[1].weight_rms);
  EXPECT_EQ(mapping.weight_rms_left_out(), mapping.trials()[2].weight_rms);
}

TEST(CrossMapping, StaysBetweenNoneAndAll) {
  const Scene scene;
  ReferencePairs pairs = scene.pairs(60);
  pairs.weights = (pairs.weights.array() > 0.5).cast<double>(); // steps overshoot
  const CrossMapping mapping(scene.pca, pairs, {.dimensions = 3, .sigma = 8.0});
  const FrameMatrixD found = mapping.weights(scene.channels_of(made_matrix(400, 8, 8.0, 3)));
  EXPECT_EQ(found.minCoeff(), 0.0);
  EXPECT_EQ(found.maxCoeff(), 1.0);
}

TEST(CrossMapping, MissingChannelsAreLeftOut) {
  const Scene scene;
  const CrossMapping mapping(scene.pca, scene.pairs(60), {.dimensions = 4});
  FrameMatrixD coefficients = made_matrix(6, 8, 6.0, 4);
  coefficients.rightCols(4).setZero(); // what the four dimensions say entirely
  FrameMatrixD channels = scene.channels_of(coefficients);
  const FrameMatrixD whole = mapping.weights(channels);
  channels(1, 4) = kMissing;
  channels.row(2).tail(15).setConstant(kMissing);
  channels.row(4).setConstant(kMissing);
  const FrameMatrixD found = mapping.weights(channels);
  EXPECT_LT((found - whole).topRows(4).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(found.row(4), found.row(3)) << "nothing to go by: as before";
  EXPECT_EQ(found.row(5), whole.row(5));
}

TEST(CrossMapping, RefusesPairsThatNothingFollowsFrom) {
  const Scene scene;
  expect_error([&] { CrossMapping(scene.pca, scene.pairs(2)); },
               "too few reference pairs for cross-mapping (expected at least 3, got 2)");
  ReferencePairs alike = scene.pairs(5);
  alike.channels = alike.channels.row(0).replicate(5, 1).eval();
  expect_error([&] { CrossMapping(scene.pca, alike); }, "all reference pairs name the same frame");
  EXPECT_THROW(CrossMappingOptions{.dimensions = -1}.validate(), UsageError);
  EXPECT_THROW(CrossMappingOptions{.sigma = kMissing}.validate(), UsageError);
}

} // namespace phonomime::test
