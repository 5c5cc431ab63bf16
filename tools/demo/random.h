// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace phonomime::demo {

// SplitMix64 (Steele, Lea, Flood 2014). The standard library's distributions differ between
// libraries, so the few that the demo needs are here.
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }

  // In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  // In [0, count); count > 0.
  int index(int count) { return static_cast<int>(uniform() * count); }

  // Mean 0, variance 1: the sum of twelve uniform numbers less 6, within [-6, 6].
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i)
      sum += uniform();
    return sum;
  }

private:
  std::uint64_t state_;
};

// A seed of its own for a named thing, so that no result depends on the order of making (FNV-1a).
inline std::uint64_t seed_for(std::uint64_t seed, std::string_view name) {
  std::uint64_t hash = 0xCBF29CE484222325u ^ seed;
  for (const char c : name)
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return Random(hash).next();
}

// A smooth random function of time with mean 0 and variance 1: three sines of random frequency
// within a band and of random phase.
class SmoothNoise {
public:
  SmoothNoise(Random& random, double low_hz, double high_hz) {
    for (Sine& sine : sines_) {
      sine.hz = random.uniform(low_hz, high_hz);
      sine.phase = random.uniform(0.0, 2.0 * std::numbers::pi);
    }
  }

  double at(double time_s) const {
    double sum = 0.0;
    for (const Sine& sine : sines_)
      sum += std::sin(2.0 * std::numbers::pi * sine.hz * time_s + sine.phase);
    return sum * std::sqrt(2.0 / 3.0);
  }

private:
  struct Sine {
    double hz = 0.0;
    double phase = 0.0;
  };
  Sine sines_[3];
};

// 0 up to `from`, 1 from `to` on, a half cosine between (from < to).
inline double ramp(double x, double from, double to) {
  if (x <= from)
    return 0.0;
  if (x >= to)
    return 1.0;
  return 0.5 - 0.5 * std::cos(std::numbers::pi * (x - from) / (to - from));
}

} // namespace phonomime::demo
