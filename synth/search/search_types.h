// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/search/surroundings.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// Weights of the cost of E4 (E Tables I and II, E5, E7), and of terms beyond the paper's
// (context_fit.h, docs/cost.md). alpha3 in 1/s, pnt in mm/s (markers).
struct CostWeights {
  double alpha1 = 0.0; // sentence start (Table I rule 4), times pnt
  double alpha2 = 0.0; // direct smoothing cost (E6)
  double alpha3 = 0.0; // position gap against velocity gap (E7)
  double alpha4 = 0.0; // same viseme, other phoneme (Table II rule 2), in (0, 1)
  double alpha5 = 0.0; // other phoneme (Table II), times pnt
  double alpha6 = 0.0; // other emotion (E5), times pnt
  double pnt = 0.0;    // PNT

  // Beyond the paper; all but the last times pnt.
  double target = 0.0;   // other motion than is expected in the context
  double context = 0.0;  // other phonemes around
  double duration = 0.0; // another duration
  double position = 0.0; // another place in the phrase
  double off_lips = 1.0; // in E8 and E9, of groups that are not of the lips; 0 to 1

  bool goes_beyond_the_paper() const {
    return target > 0.0 || context > 0.0 || duration > 0.0 || position > 0.0;
  }
};

// Which terms a cost has.
enum class CostModel { paper, context };
inline constexpr std::array<std::string_view, 2> kCostModelNames = {"paper", "context"};

// One phoneme of the transcript as the search sees it.
struct SearchStep {
  std::int32_t phoneme = 0; // into MotionTable::phonemes; -1 = the database has no such phoneme
  std::int32_t viseme = 0;  // into MotionTable::visemes; -1 = none such
  std::int32_t emotion = 0; // into MotionTable::emotions; -1 = none such
  bool is_silence = false;
  std::vector<NodeIndex> allowed; // sorted; empty = every node (B of E10)
  std::vector<NodeIndex> avoided; // sorted
  Surroundings surroundings;      // asked for by the terms beyond the paper's
};

// Terms beyond the paper's, times their weights.
struct FitCost {
  double target = 0.0;
  double context = 0.0;
  double duration = 0.0;
  double position = 0.0;
  double sum() const { return (target + context) + (duration + position); }
};

// Cost terms of one step of a path.
struct StepCost {
  double observation = 0.0; // E Table II
  double emotion = 0.0;     // E5
  FitCost fit;              // beyond the paper
  double transition = 0.0;  // E Table I, the incoming join; 0 at the first step
};

struct NodePath {
  double cost = 0.0;            // E4, summed as (phi + TC) + ((OC + EMP) + fit)
  std::vector<NodeIndex> nodes; // one per step
  std::vector<StepCost> steps;  // one per step
};

} // namespace phonomime
