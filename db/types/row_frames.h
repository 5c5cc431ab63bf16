// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/frame_times.h"
#include "db/types/phoneme_set.h"

#include <span>
#include <vector>

namespace phonomime {

// The frames of each row of an alignment or transcript, one range a row (assign_frames), those of
// its motion nodes: a phoneme has at least one where there are enough. `rows` follow on one another
// from 0 without holes.
std::vector<FrameRange> row_frames(std::span<const TimedPhoneme> rows, double rate_hz);

} // namespace phonomime
