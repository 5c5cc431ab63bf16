// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace phonomime {

// Frame k of a rate r is at k / r and belongs to start <= t < end (DESIGN section 11). Times and
// rates are decimal text more often than not, so that 0.07 s at 100 Hz must be frame 7 although
// 0.07 * 100 > 7: a frame nearer to a time than 1e-9 of its index (at least 1e-9 frames) is at it.
// Times are finite, rates positive, and their product is under 2^52 in magnitude.

// The first frame at or after a time: the least k with time_s <= k / rate_hz.
std::int64_t first_frame_at(double time_s, double rate_hz);

// How many frames from 0 on are at or before a time: #k >= 0 with k / rate_hz <= end_s.
std::int64_t frame_count_to(double end_s, double rate_hz);

// A stretch of time that frames are shared out to, half-open.
struct TimeSpan {
  double start_s = 0.0;
  double end_s = 0.0;
  bool needs_frame = true; // a phoneme does, silence does not
};

// Frames first, first + 1, ... first + count - 1.
struct FrameRange {
  std::int64_t first = 0;
  std::int64_t count = 0;
  std::int64_t end() const { return first + count; }
};

// Shares the frames of a rate out to spans that follow each other without a gap: one range a span,
// each beginning where the one before ends, from first_frame_at(first start) to
// first_frame_at(last end). A span that needs a frame and catches none takes the nearest one of its
// longer neighbour that can spare one; where neither can, of the nearest span that can, and the
// spans between move by a frame. Whoever needs a frame keeps one. Only where there are fewer frames
// than such spans do some stay empty.
std::vector<FrameRange> assign_frames(std::span<const TimeSpan> spans, double rate_hz);

} // namespace phonomime
