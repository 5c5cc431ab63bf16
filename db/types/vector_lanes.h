// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>

namespace phonomime {

// Numbers that the compiler keeps in vector registers of whatever width there is. Loops over lanes
// with a function of the standard library become one instruction.
inline constexpr std::size_t kFloatLanes = 8;
inline constexpr std::size_t kDoubleLanes = 4;
using FloatLanes = float __attribute__((vector_size(kFloatLanes * sizeof(float))));
using DoubleLanes = double __attribute__((vector_size(kDoubleLanes * sizeof(double))));

inline void load(FloatLanes& lanes, const float* from) {
  std::memcpy(&lanes, from, sizeof lanes);
}
inline void load(DoubleLanes& lanes, const double* from) {
  std::memcpy(&lanes, from, sizeof lanes);
}
inline void load(DoubleLanes& lanes, const float* from) {
  for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
    lanes[lane] = static_cast<double>(from[lane]);
  }
}

inline void take_roots(FloatLanes& lanes) {
  for (std::size_t lane = 0; lane < kFloatLanes; ++lane) {
    lanes[lane] = std::sqrt(lanes[lane]);
  }
}
inline void take_roots(DoubleLanes& lanes) {
  for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
    lanes[lane] = std::sqrt(lanes[lane]);
  }
}

inline float sum_of_lanes(const FloatLanes& lanes) {
  return ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) +
         ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]));
}
inline double sum_of_lanes(const DoubleLanes& lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

// Sum over groups of the Euclidean norm of b - a, group k in lane k mod the number of lanes; planes
// of `stride` numbers, one per axis, stride a multiple of the number of lanes.
template <typename Lanes, std::size_t kLanes, std::size_t kAxes>
inline auto summed_norms(const float* a, const float* b, std::size_t stride) {
  Lanes sum = {};
  for (std::size_t k = 0; k < stride; k += kLanes) {
    Lanes square = {};
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      Lanes from, to;
      load(from, a + axis * stride + k);
      load(to, b + axis * stride + k);
      const Lanes difference = to - from;
      square += difference * difference;
    }
    take_roots(square);
    sum += square;
  }
  return sum_of_lanes(sum);
}

} // namespace phonomime
