// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "tools/demo/articulation.h"
#include "tools/demo/segments.h"

namespace phonomime::demo {

// The mouth at one frame, and how far a contact of its lips is in force there (0 to 1).
struct ArticulatoryFrame {
  Articulators value{};
  double lip_closure = 0.0; // p b m
  double lip_tuck = 0.0;    // f v
};

// What an emotion does to articulation: factors on the targets' jaw and aperture, on their positive
// widths, and on their rounding (negative widths and protrusion).
struct ArticulationGain {
  double opening = 1.0;
  double spreading = 1.0;
  double rounding = 1.0;
};

// Length of the ramp with which a contact begins before its core and ends after it.
inline constexpr double kContactRamp_s = 0.05;
// The core of a contact is its phoneme less this share at either end.
inline constexpr double kContactMargin = 0.2;
// Standard deviation of the Gaussian that smooths the blend: -3 dB at 11 Hz.
inline constexpr double kBlendSigma_s = 0.012;

// Number of frames k / rate_hz in [0, end_s).
int frame_count(double end_s, double rate_hz);

// Coarticulation after Cohen and Massaro (1993): at time t each parameter is the mean of all
// targets, weighted by D = alpha exp(-theta |tau|^c), c = 1, tau the time from the target's core,
// theta by parameter. The blend is smoothed (kBlendSigma_s), and then the contacts of /p b m/ and
// /f v/ are laid over it in full. #frames as frame_count(end of the last segment, rate_hz).
std::vector<ArticulatoryFrame> articulate(std::span<const Segment> segments, double rate_hz,
                                          const ArticulationGain& gain);

} // namespace phonomime::demo
