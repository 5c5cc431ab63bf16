// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/motion_csv.h"

#include "db/import/readers.h"
#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/live_link_columns.h"
#include "db/types/text.h"
#include "tests/support/shared_data.h"
#include "tests/synth/retarget/made_mesh.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

// A PCA that keeps every channel: coefficients are channels.
PcaModel identity_pca(Eigen::Index channels) {
  PcaModel pca;
  pca.mean = Eigen::VectorXd::Zero(channels);
  pca.basis = Eigen::MatrixXd::Identity(channels, channels);
  pca.variance = Eigen::VectorXd::Ones(channels);
  return pca;
}

CoefficientMotion wavy(Eigen::Index frames, Eigen::Index channels, double rate_hz) {
  CoefficientMotion motion;
  motion.rate_hz = rate_hz;
  motion.coefficients.resize(frames, channels);
  for (Eigen::Index k = 0; k < frames; ++k) {
    for (Eigen::Index c = 0; c < channels; ++c) {
      motion.coefficients(k, c) = 100.0 * std::sin(0.1 * static_cast<double>(k * (c + 1)) + 0.3);
    }
  }
  return motion;
}

TEST(MarkerCsv, IsReadBack) {
  const Layout layout = test::made_layout({{"lm1", {}, ""}, {"chin", {}, ""}});
  for (const double rate : {24.0, 29.97, 30.0, 120.0}) {
    const CoefficientMotion motion = wavy(50, 6, rate);
    const MotionClip clip =
        parse_marker_csv(marker_csv(layout, identity_pca(6), motion, false), "out.csv");
    EXPECT_EQ(clip.groups, (std::vector<std::string>{"lm1", "chin"}));
    EXPECT_NEAR(clip.rate_hz, rate, 1e-3);
    ASSERT_EQ(clip.frames.rows(), 50);
    EXPECT_LT((clip.frames.cast<double>() - motion.coefficients).cwiseAbs().maxCoeff(), 1e-4);
  }
}

TEST(MarkerCsv, PutsTheHeadBackWhereAsked) {
  const Layout layout = test::made_layout({{"lm1", {}, ""}});
  CoefficientMotion motion = wavy(3, 3, 30.0);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()));
  motion.head.assign(3, {.translation_mm = {1, 2, 3}, .rotation = turn});
  const auto read = [&](bool head) {
    return Eigen::MatrixXd(
        parse_marker_csv(marker_csv(layout, identity_pca(3), motion, head), "out.csv")
            .frames.cast<double>());
  };
  EXPECT_LT((read(false) - motion.coefficients).cwiseAbs().maxCoeff(), 1e-4);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d expected =
        turn * motion.coefficients.row(k).transpose() + Eigen::Vector3d(1, 2, 3);
    EXPECT_LT((read(true).row(k).transpose() - expected).norm(), 2e-4);
  }
}

TEST(MarkerCsv, WritesNoNegativeZero) {
  const Layout layout = test::made_layout({{"lm1", {}, ""}});
  CoefficientMotion motion = wavy(1, 3, 30.0);
  motion.coefficients << -0.00001, 0.0, -1.5;
  EXPECT_EQ(marker_csv(layout, identity_pca(3), motion, false),
            "time,lm1_x,lm1_y,lm1_z\n0.000000,0.0000,0.0000,-1.5000\n");
}

Layout weight_layout(const std::vector<std::string>& names) {
  Layout layout;
  layout.kind = LayoutKind::weights;
  for (const std::string& name : names) {
    layout.groups.push_back({name, {}});
  }
  return layout;
}

TEST(WeightCsv, NamesItsColumns) {
  CoefficientMotion motion = wavy(2, 2, 30.0);
  motion.coefficients << 0.25, 1.0, 0.5, 0.0;
  EXPECT_EQ(weight_csv(weight_layout({"smile", "frown"}), identity_pca(2), motion),
            "time,smile,frown\n0.000000,0.250000,1.000000\n0.033333,0.500000,0.000000\n");
}

TEST(LiveLinkCsv, HasTheColumnsOfARecordedTakeAndIsReadBack) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  for (const char* take :
       {"livelink/alexdjulin/alex_rom_3.csv", "livelink/sentien/recording.csv"}) {
    const std::string recorded = read_file(data / take);
    const MotionClip clip = parse_live_link_csv(recorded, take);
    const Layout layout = weight_layout(clip.groups);
    ASSERT_TRUE(is_live_link_layout(layout));
    CoefficientMotion motion;
    motion.rate_hz = 30.0;
    motion.coefficients = clip.frames.cast<double>().topRows(90);
    const std::string text = live_link_csv(layout, identity_pca(61), motion);
    EXPECT_EQ(to_lower(split_lines(text)[0]), to_lower(split_lines(recorded)[0]));
    EXPECT_TRUE(split_lines(text)[31].starts_with("00:00:01:00.000,61,"));
    EXPECT_TRUE(split_lines(text)[2].starts_with("00:00:00:02.000,61,"));
    const MotionClip again = parse_live_link_csv(text, "out.csv");
    EXPECT_EQ(again.groups, clip.groups);
    EXPECT_NEAR(again.rate_hz, 30.0, 0.05);
    EXPECT_LT((again.frames - clip.frames.topRows(90)).cwiseAbs().maxCoeff(), 1e-6f);
  }
}

TEST(LiveLinkCsv, IsForItsOwnLayoutOnly) {
  const Layout layout = weight_layout({"smile", "frown"});
  EXPECT_FALSE(is_live_link_layout(layout));
  EXPECT_THROW(live_link_csv(layout, identity_pca(2), wavy(2, 2, 30.0)), InternalError);
}

// A motion that comes in parts makes the same file, of markers, of ARKit's shapes and of others.
TEST(MotionCsv, InPartsIsTheWhole) {
  const Layout markers = test::made_layout({{"lm1", {}, ""}, {"chin", {}, ""}});
  Layout others{.kind = LayoutKind::weights, .groups = {{.name = "smile"}, {.name = "frown"}}};
  Layout arkit{.kind = LayoutKind::weights};
  for (std::size_t i = 0; i < kArkitShapeCount; ++i) {
    arkit.groups.push_back({.name = std::string(kLiveLinkColumns[i])});
  }
  for (const Layout& layout : {markers, others, arkit}) {
    const Eigen::Index channels =
        layout.group_count() * (layout.kind == LayoutKind::markers ? 3 : 1);
    const PcaModel pca = identity_pca(channels);
    CoefficientMotion motion = wavy(50, channels, 29.97);
    motion.head.assign(50, {.translation_mm = {1, 2, 3}, .rotation = {}});
    std::string text = motion_csv_header(layout);
    for (Eigen::Index first = 0; first < 50; first += 7) {
      const Eigen::Index count = std::min<Eigen::Index>(7, 50 - first);
      CoefficientMotion part{
          .rate_hz = motion.rate_hz,
          .coefficients = motion.coefficients.middleRows(first, count),
          .head = {motion.head.begin() + first, motion.head.begin() + first + count}};
      text += motion_csv_rows(layout, pca, part, true, first);
    }
    EXPECT_EQ(text, layout.kind == LayoutKind::markers ? marker_csv(layout, pca, motion, true)
                    : is_live_link_layout(layout)      ? live_link_csv(layout, pca, motion)
                                                       : weight_csv(layout, pca, motion));
  }
}

} // namespace
} // namespace phonomime
