// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/reconstruction_error.h"

#include "synth/retarget/keyshapes/region_basis.h"
#include "tests/support/shared_data.h"
#include "tests/synth/retarget/real_motion.h"

#include <gtest/gtest.h>

namespace phonomime {
namespace {

TEST(ReconstructionError, IsThatOfTheNearestPointOfACone) {
  // Keyshapes along x and y: what is left of (3, 4, 2) is its z, of (-1, 2, 0) its x.
  FrameMatrixD offsets(4, 3);
  offsets << 1, 0, 0, 0, 2, 0, 3, 4, 2, -1, 2, 0;
  EXPECT_NEAR(reconstruction_error({.offsets = offsets}, {0, 1}), (4.0 + 1.0) / 4.0, 1e-12);
  EXPECT_NEAR(reconstruction_error({.offsets = offsets}, {0, 1, 2, 3}), 0.0, 1e-12);
}

// T figure 3.6 on recordings.
TEST(ReconstructionError, OfExtremaFallsWithEachKeyshapeOfARecording) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  const test::RealMotion motion = test::read_real_motion(data, 100);
  const FrameMatrixD frames =
      (motion.channels.rowwise() - motion.pca.mean.transpose()) * motion.pca.basis;
  const std::vector<int> channels = part_channels(motion.layout, "lower");
  const FrameMatrixD points = part_coefficients(motion.pca, frames, channels);
  const KeyshapeMeasure measure{.offsets =
                                    part_offsets(motion.pca, frames, channels, motion.reference),
                                .groups = static_cast<int>(channels.size()) / 3,
                                .every = 5};
  const std::vector<ErrorCurve> curves = error_curves(points, measure, {.count = 24}, 8);
  ASSERT_EQ(curves.size(), 4u);
  const std::vector<KeyshapeError>& extrema = curves[0].errors;
  ASSERT_EQ(extrema.size(), 8u);
  for (std::size_t i = 1; i < extrema.size(); ++i) {
    EXPECT_LE(extrema[i].mean_square, extrema[i - 1].mean_square);
  }
  EXPECT_EQ(extrema.back().count, 24);
  EXPECT_LT(extrema.back().mean_square, 0.2 * motion_square(measure));
  EXPECT_LT(extrema.back().mean_square, curves[1].errors.back().mean_square);
  // On axes of their own offsets have as many numbers as the PCA, and the same errors.
  const KeyshapeMeasure shorter{
      .offsets = part_offset_coordinates(motion.pca, frames, channels, motion.reference),
      .groups = measure.groups,
      .every = 5};
  EXPECT_EQ(shorter.offsets.cols(), 26);
  EXPECT_NEAR(motion_square(shorter), motion_square(measure), 1e-9);
  EXPECT_NEAR(error_curves(points, shorter, {.count = 24}, 8)[0].errors[2].mean_square,
              extrema[2].mean_square, 1e-9);
  const std::string table = error_table_tsv(curves);
  EXPECT_EQ(std::ranges::count(table, '\n'), 1 + 8 + 8 + 8 + 1);
  EXPECT_NE(error_plot_svg(curves, "mm\xC2\xB2").find("clusters, 3 dimensions"), std::string::npos);
}

} // namespace
} // namespace phonomime
