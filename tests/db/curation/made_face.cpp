// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/db/curation/made_face.h"

#include <cmath>
#include <random>

namespace phonomime::test {

namespace {

// The same numbers with every standard library, unlike its distributions.
double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53 * 2.0 - 1.0;
}

double nearly_normal(std::mt19937_64& random) {
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) {
    sum += uniform(random);
  }
  return sum / 2.0; // twelve of variance 1/3
}

} // namespace

Layout made_face() {
  Layout layout;
  for (int i = 0; i < kFaceMarkers; ++i) {
    layout.groups.push_back({"m" + std::to_string(i), {Region::lips}});
  }
  return layout;
}

FrameMatrix made_motion(Eigen::Index frames, std::uint64_t seed, double noise_mm) {
  constexpr int kMovements = 6;
  std::mt19937_64 random(seed);
  double hz[kMovements], phase[kMovements];
  for (int m = 0; m < kMovements; ++m) {
    hz[m] = 2.0 + 1.5 * uniform(random);
    phase[m] = 3.0 * uniform(random);
  }
  FrameMatrix motion(frames, 3 * kFaceMarkers);
  for (Eigen::Index k = 0; k < frames; ++k) {
    const double t = static_cast<double>(k) / kFaceRate_hz;
    for (int i = 0; i < kFaceMarkers; ++i) {
      const double x = 10.0 * (i % 5), y = -10.0 * (i / 5);
      double at[3] = {x, y, 0.0};
      for (int m = 0; m < kMovements; ++m) {
        // Smooth over the skin: what one marker does, its neighbours nearly do.
        const double share = std::cos(0.03 * (m + 1) * x + 0.5 * m) * std::cos(0.02 * m * y);
        at[m % 3] += 3.0 * share * std::sin(2.0 * M_PI * hz[m] * t + phase[m]);
      }
      for (int c = 0; c < 3; ++c) {
        motion(k, 3 * i + c) = static_cast<float>(at[c] + noise_mm * nearly_normal(random));
      }
    }
  }
  return motion;
}

StoredSentence made_sentence(const std::string& name, Eigen::Index frames, std::uint64_t seed) {
  constexpr const char* kPhonemes[] = {"aa", "b", "k"};
  StoredSentence sentence;
  sentence.id = static_cast<std::int64_t>(seed);
  sentence.speaker = "ann";
  sentence.emotion = "neutral";
  sentence.name = name;
  sentence.channels = made_motion(frames, seed);
  sentence.frame_has_gap.assign(static_cast<std::size_t>(frames), 0);
  for (std::int32_t first = 10, row = 1; first + 20 <= frames; first += 10, ++row) {
    StoredSentence::Node node;
    node.row = row;
    node.phoneme = kPhonemes[row % 3];
    node.duration_s = 0.1;
    node.first_frame = first;
    node.frame_count = 10;
    sentence.nodes.push_back(node);
  }
  return sentence;
}

} // namespace phonomime::test
