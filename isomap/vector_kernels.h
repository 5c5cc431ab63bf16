// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstring>

// Marks a kernel that is compiled for plain x86-64 and for AVX2, chosen once at load time. Both
// give the same bytes: the order of every sum is fixed in the source and nothing is fused. The
// sanitizers' start-up does not survive such a choice, so that they run the plain kernel.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PHONOMIME_MAP_KERNEL __attribute__((target_clones("default", "avx2")))
#else
#define PHONOMIME_MAP_KERNEL
#endif

namespace phonomime::map_kernels {

// Numbers that the compiler keeps in vector registers of whatever width there is.
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

inline double sum_of_lanes(const DoubleLanes& lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

} // namespace phonomime::map_kernels
