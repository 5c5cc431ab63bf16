// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "tests/tools/demo/support.h"
#include "tools/demo/corruption.h"
#include "tools/demo/marker_layout.h"
#include "tools/demo/mask_face.h"
#include "tools/demo/random.h"

namespace phonomime::demo {
namespace {

constexpr double kRate = 120.0;

std::vector<std::vector<Segment>> sentences(int count) {
  Random random(1);
  std::vector<std::vector<Segment>> all;
  for (int i = 0; i < count; ++i)
    all.push_back(sequence({{"pau", 0.3},
                            {"b", 0.06},
                            {"aa", random.uniform(0.05, 0.2)},
                            {"t", 0.06},
                            {"iy", random.uniform(0.05, 0.2)},
                            {"pau", 0.4}}));
  return all;
}

std::vector<PlantedFault> planned(int count) {
  std::vector<PlantedFault> all;
  for (const auto& faults : plan_faults(sentences(count), mask_face_model().rest, 7))
    all.insert(all.end(), faults.begin(), faults.end());
  return all;
}

TEST(Corruption, PlansAFewOfEveryKindOffTheRigidMarkers) {
  const Layout layout = marker_layout();
  std::map<Fault, int> kinds;
  int brief = 0;
  int lengthy = 0;
  for (const PlantedFault& fault : planned(224)) {
    ++kinds[fault.fault];
    const double length_s = fault.end_s - fault.start_s;
    for (const int marker : fault.markers)
      EXPECT_FALSE(layout.groups[static_cast<std::size_t>(marker)].in(Region::rigid));
    if (fault.fault == Fault::dropout)
      ++(length_s <= 0.1 ? brief : lengthy);
    if (fault.fault == Fault::freeze) {
      EXPECT_GE(length_s, 0.1);
    }
    if (fault.fault == Fault::jump) {
      EXPECT_GE(fault.offset_mm.norm(), 5.0);
      EXPECT_LE(fault.offset_mm.norm(), 15.0);
    }
    if (fault.fault == Fault::swap) {
      ASSERT_EQ(fault.markers.size(), 2u);
      EXPECT_NE(fault.markers[0], fault.markers[1]);
    }
  }
  for (const Fault kind : {Fault::swap, Fault::jump, Fault::freeze, Fault::drift})
    EXPECT_EQ(kinds[kind], 3);
  EXPECT_GT(brief, lengthy);
  EXPECT_GT(lengthy, 0);
}

TEST(Corruption, ChangesTheStatedMarkersAndFramesOnly) {
  Random random(2);
  std::vector<MarkerPose> clean;
  for (int k = 0; k < 240; ++k)
    clean.push_back(MarkerPose::NullaryExpr(91, 3, [&] { return random.normal(); }));
  for (const PlantedFault& fault : planned(224)) {
    std::vector<MarkerPose> frames = clean;
    plant(fault, kRate, frames);
    bool changed = false;
    for (int k = 0; k < 240; ++k)
      for (int marker = 0; marker < 91; ++marker) {
        const bool meant = k / kRate >= fault.start_s && k / kRate < fault.end_s &&
                           std::count(fault.markers.begin(), fault.markers.end(), marker) > 0;
        const auto& now = frames[static_cast<std::size_t>(k)].row(marker);
        const auto& before = clean[static_cast<std::size_t>(k)].row(marker);
        if (!meant) {
          ASSERT_EQ(now, before) << fault_name(fault.fault);
        } else if (fault.fault == Fault::dropout) {
          ASSERT_TRUE(now.array().isNaN().all());
        }
        changed = changed || now != before;
      }
    EXPECT_TRUE(changed) << fault_name(fault.fault);
  }
}

TEST(Corruption, SwapExchangesAndJumpMovesByItsOffset) {
  const MarkerPose pose = MarkerPose::Random(91, 3);
  std::vector<MarkerPose> frames(30, pose);
  plant({.fault = Fault::swap, .markers = {3, 8}, .start_s = 0.0, .end_s = 0.1}, kRate, frames);
  EXPECT_EQ(frames[5].row(3), pose.row(8));
  EXPECT_EQ(frames[5].row(8), pose.row(3));
  plant({.fault = Fault::jump,
         .markers = {20},
         .start_s = 0.0,
         .end_s = 0.1,
         .offset_mm = {1.0, 2.0, 3.0}},
        kRate, frames);
  EXPECT_EQ(frames[5].row(20), pose.row(20) + Eigen::RowVector3d(1.0, 2.0, 3.0));
}

} // namespace
} // namespace phonomime::demo
