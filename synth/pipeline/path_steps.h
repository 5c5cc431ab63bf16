// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "db/types/phoneme_set.h"
#include "synth/concat/concatenate.h"

#include <cstddef>
#include <span>
#include <vector>

namespace phonomime {

// Whether the node of row `i` was recorded after that of the row before; never beside /pau/
// (DESIGN 11). `nodes`: one for each row of the transcript, kNoNode where there is none.
bool is_captured(const MotionTable& table, std::span<const TimedPhoneme> transcript,
                 std::span<const NodeIndex> nodes, std::size_t i);

// The rows of a transcript with a path's nodes, for concatenate(). No /pau/ shows its node.
std::vector<ConcatStep> path_steps(const MotionTable& table,
                                   std::span<const TimedPhoneme> transcript,
                                   std::span<const NodeIndex> nodes);

} // namespace phonomime
