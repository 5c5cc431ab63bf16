// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/region_basis.h"

#include "tests/support/expect_error.h"

#include <random>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

Layout small_layout() {
  Layout layout;
  layout.groups = {{"lip", {Region::lips}},
                   {"brow", {Region::brows}},
                   {"skull", {Region::rigid}},
                   {"fold", {Region::cheeks, Region::eyelids}}};
  return layout;
}

Eigen::MatrixXd normal(std::mt19937_64& draw, Eigen::Index rows, Eigen::Index columns) {
  std::normal_distribution<double> number;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return number(draw); });
}

TEST(RegionBasis, PartsTakeTheirRegionsGroups) {
  const Layout layout = small_layout();
  EXPECT_EQ(part_channels(layout, "face").size(), 12u);
  EXPECT_EQ(part_channels(layout, "upper"), (std::vector<int>{3, 4, 5}));
  EXPECT_EQ(part_channels(layout, "lower"), (std::vector<int>{0, 1, 2, 9, 10, 11}));
  EXPECT_EQ(part_channels(layout, "eyelids"), (std::vector<int>{9, 10, 11}));
  test::expect_error([&] { part_channels(layout, "lowr"); }, "Did you mean \"lower\"");
  test::expect_error([&] { part_channels(layout, "jaw"); }, "no groups in the part \"jaw\"");
}

TEST(RegionBasis, AxesKeepThePartsDistancesAndFallInVariance) {
  std::mt19937_64 draw(2);
  PcaModel pca;
  pca.mean = normal(draw, 12, 1);
  pca.basis = Eigen::HouseholderQR<Eigen::MatrixXd>(normal(draw, 12, 12)).householderQ() *
              Eigen::MatrixXd::Identity(12, 5);
  const FrameMatrixD frames = normal(draw, 60, 5);
  const Eigen::VectorXd reference = normal(draw, 12, 1);
  for (const std::string_view part : {"face", "lower", "upper"}) {
    const std::vector<int> channels = part_channels(small_layout(), part);
    const FrameMatrixD axes = part_coefficients(pca, frames, channels);
    const FrameMatrixD offsets = part_offsets(pca, frames, channels, reference);
    const Eigen::VectorXd whole = pca.reconstruct(frames.row(7).transpose()) - reference;
    EXPECT_LT((offsets.row(7).transpose() - whole(channels)).norm(), 1e-12);
    const Eigen::MatrixXd covariance = axes.transpose() * axes;
    for (Eigen::Index d = 0; d < axes.cols(); ++d) {
      for (Eigen::Index other = 0; other < d; ++other) {
        EXPECT_NEAR(covariance(d, other), 0.0, 1e-9);
      }
      EXPECT_TRUE(d == 0 || covariance(d, d) <= covariance(d - 1, d - 1) + 1e-9);
    }
    for (Eigen::Index i = 1; i < 60; ++i) {
      EXPECT_NEAR((axes.row(i) - axes.row(0)).norm(), (offsets.row(i) - offsets.row(0)).norm(),
                  1e-9);
    }
  }
}

} // namespace
} // namespace phonomime
