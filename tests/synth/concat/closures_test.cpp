// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/readers.h"
#include "db/types/frame_times.h"
#include "db/types/lip_measures.h"
#include "synth/concat/resample.h"
#include "tests/support/shared_data.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

double inner_lips_mm(const MotionClip& clip, Eigen::Index frame) {
  const auto height = [&](const char* name) {
    const auto group = std::find(clip.groups.begin(), clip.groups.end(), name);
    return static_cast<double>(clip.frames(frame, 3 * (group - clip.groups.begin()) + 1));
  };
  return height("lm13") - height("lm14");
}

// A recording's aperture at 100 Hz, straight between recorded frames; empty where markers are
// missing.
CoefficientMotion aperture_of(const MotionClip& clip) {
  CoefficientMotion motion;
  motion.rate_hz = 100.0;
  const double last_s = static_cast<double>(clip.frame_count() - 1) / clip.rate_hz;
  motion.coefficients.resize(frame_count_to(last_s, 100.0), 1);
  for (Eigen::Index k = 0; k < motion.coefficients.rows(); ++k) {
    const double u = static_cast<double>(k) / 100.0 * clip.rate_hz;
    const auto before = std::min(static_cast<Eigen::Index>(u), clip.frame_count() - 2);
    const double share = u - static_cast<double>(before);
    motion.coefficients(k, 0) =
        (1.0 - share) * inner_lips_mm(clip, before) + share * inner_lips_mm(clip, before + 1);
  }
  return motion;
}

double at(const CoefficientMotion& motion, double time_s) {
  const double u =
      std::min(time_s * motion.rate_hz, static_cast<double>(motion.coefficients.rows() - 1));
  const auto before = static_cast<Eigen::Index>(u);
  const auto after = std::min(before + 1, motion.coefficients.rows() - 1);
  const double share = u - static_cast<double>(before);
  return (1.0 - share) * motion.coefficients(before, 0) + share * motion.coefficients(after, 0);
}

// On recorded lips: of the /p b m/ that are seen closed at the instants of a 30 Hz picture, the
// low-pass in front of the 30 Hz samples opens hardly any, and lifts them by little on the whole.
TEST(Closures, SurviveTheLowPassTo30Hz) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  std::vector<std::filesystem::path> labels;
  for (const auto& entry : std::filesystem::directory_iterator(data / "grid_s1" / "alignment")) {
    if (entry.path().extension() == ".lab") {
      labels.push_back(entry.path());
    }
  }
  std::sort(labels.begin(), labels.end());
  int closed = 0;
  int still_closed = 0;
  double lift_mm = 0.0;
  for (std::size_t i = 0; i < labels.size(); i += 4) {
    const auto file = data / "grid_s1" / "motion" / (labels[i].stem().string() + ".c3d");
    const CoefficientMotion aperture = aperture_of(read_motion(file));
    if (!aperture.coefficients.allFinite()) {
      continue;
    }
    const double end_s = static_cast<double>(aperture.coefficients.rows() - 1) / 100.0;
    const CoefficientMotion output = resample_motion(aperture, 30.0, end_s);
    for (const AlignedLabel& row : read_alignment(labels[i]).rows) {
      if (row.label != "p" && row.label != "b" && row.label != "m") {
        continue;
      }
      double sampled = kClosedAperture_mm;
      double filtered = 1e9;
      for (auto k = first_frame_at(row.start_s, 30.0);
           k < std::min(first_frame_at(row.end_s, 30.0), output.coefficients.rows()); ++k) {
        sampled = std::min(sampled, at(aperture, static_cast<double>(k) / 30.0));
        filtered = std::min(filtered, output.coefficients(k, 0));
      }
      if (sampled < kClosedAperture_mm) {
        ++closed;
        still_closed += filtered < kClosedAperture_mm ? 1 : 0;
        lift_mm += filtered - sampled;
      }
    }
  }
  RecordProperty("closed", closed);
  RecordProperty("still_closed", still_closed);
  ASSERT_GT(closed, 100);
  EXPECT_GE(still_closed, 0.98 * closed);
  EXPECT_LT(lift_mm / closed, 0.1);
}

} // namespace
} // namespace phonomime
