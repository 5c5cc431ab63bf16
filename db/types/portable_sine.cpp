// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/portable_sine.h"

#include <cmath>
#include <numbers>

namespace phonomime {
namespace {

// Taylor series up to |angle| = pi / 4, where the first term left out is under 1e-16.
double sine_near_zero(double angle) {
  const double square = angle * angle;
  double sum = 0.0;
  for (int odd = 15; odd >= 3; odd -= 2) {
    sum = -(sum + 1.0) * square / static_cast<double>(odd * (odd - 1));
  }
  return angle + angle * sum;
}

double cosine_near_zero(double angle) {
  const double square = angle * angle;
  double sum = 0.0;
  for (int even = 16; even >= 2; even -= 2) {
    sum = -(sum + 1.0) * square / static_cast<double>(even * (even - 1));
  }
  return 1.0 + sum;
}

} // namespace

double sin_pi(double x) {
  const double whole = std::nearbyint(x);
  const double rest = x - whole; // exact, in [-1/2, 1/2]
  const double distance = std::abs(rest);
  const double magnitude = distance <= 0.25 ? sine_near_zero(std::numbers::pi * distance)
                                            : cosine_near_zero(std::numbers::pi * (0.5 - distance));
  const bool odd = std::fmod(whole, 2.0) != 0.0;
  return (rest < 0.0) != odd ? -magnitude : magnitude;
}

} // namespace phonomime
