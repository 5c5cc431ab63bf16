// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/search/search_types.h"

#include <cstdint>
#include <random>
#include <vector>

namespace phonomime::test {

// The random source of these tests: its algorithm is fixed by the standard, and so are the numbers
// drawn here (std's distributions are not).
class Draw {
public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  int below(int bound) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(bound)); }
  bool chance(double p) { return unit() < p; }
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double symmetric() { return 2.0 * unit() - 1.0; }

private:
  std::mt19937_64 engine_;
};

struct TableShape {
  int groups = 5;
  int lips = 0; // of the groups
  int dimensions = 4;
  int phonemes = 6; // silence not counted
  int visemes = 3;
  int emotions = 3;
  int sentences = 6;
  int longest_sentence = 7;
  double duplicate_chance = 0.0; // a sentence repeats the motion of the one before: ties
  LayoutKind kind = LayoutKind::markers;
};

// A small database with smooth random motion, inner pauses (which break predecessor links) and
// nodes of one and two frames among them.
MotionTable random_table(const TableShape& shape, Draw& draw);

// A transcript for it: matching and unknown phonemes, inner pauses, constraints.
std::vector<SearchStep> random_steps(const MotionTable& table, int length, Draw& draw,
                                     double constraint_chance = 0.1, double pause_chance = 0.1);

CostWeights random_weights(Draw& draw);

std::vector<NodeIndex> all_nodes(const MotionTable& table);

} // namespace phonomime::test
