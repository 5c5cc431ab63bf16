// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace phonomime {

// A phoneme in time; what lies between them is /pau/.
struct SpokenPhoneme {
  double start_s = 0.0;
  double end_s = 0.0;
  std::int32_t phoneme = 0; // into MotionTable::phonemes; -1 = the database has no such phoneme
};

// What is said around a phoneme, and how long and where it is: what costs beyond the paper's ask of
// a node and of a step of the transcript (docs/cost.md). Phonemes into MotionTable::phonemes, 0 =
// /pau/, -1 = none that the database has.
struct Surroundings {
  // Times before a phoneme's start, or after its end, at which `before` and `after` look.
  static constexpr std::size_t kLooks = 10;
  static constexpr double kFirstLook_s = 0.015;
  static constexpr double kLookStep_s = 0.030;

  std::array<std::int32_t, kLooks> before{}; // from near to far
  std::array<std::int32_t, kLooks> after{};
  std::int32_t previous = 0, next = 0;               // neighbours; /pau/ at a pause
  std::int32_t second_previous = 0, second_next = 0; // and theirs
  double duration_s = 0.0;
  double position = 0.5; // of its middle in its phrase, from pause to pause, 0 to 1

  bool operator==(const Surroundings&) const = default;
};

// Of phoneme `i` of an utterance in order of time. Phonemes less than `hole_s` apart are
// neighbours.
Surroundings surroundings_of(std::span<const SpokenPhoneme> utterance, std::size_t i,
                             double hole_s);

// Of every node of a table, as it was recorded.
std::vector<Surroundings> recorded_surroundings(const MotionTable& table);

} // namespace phonomime
