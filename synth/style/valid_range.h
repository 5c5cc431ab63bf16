// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/style/restyler.h"

#include <string>
#include <vector>

namespace phonomime {

// How far an emotion can be taken before faces leave the recorded ones (T: "a non-valid face image
// can be produced" where the weight is far from 0 and 1).
struct ValidRange {
  std::string emotion;
  double largest_intensity = 0.0; // of kIntensitySteps
};

inline constexpr double kIntensityStep = 0.05;
inline constexpr double kIntensityEnd = 3.0; // no further is tried
// A face is strange where it is farther from the mean, in standard deviations of the PCA, than 99 %
// of the recorded ones; a twentieth of strange faces ends the range.
inline constexpr double kRecordedShare = 0.99, kStrangeShare = 0.05;

// By the nodes of the neutral style, taken to each other style at rising intensities, 0 first.
// `styles`: of the restyler. An intensity of 1 may lie outside where the model is poor.
std::vector<ValidRange> valid_ranges(const MotionTable& table, const Restyler& restyler,
                                     const std::vector<std::string>& styles,
                                     const std::string& neutral);

} // namespace phonomime
