// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/frame_times.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace phonomime {

// Shares frames out to spans that come one after the other, as assign_frames does to all at once. A
// span's frames are final once no later span, however short, can take one of them.
//
// For that, a span that catches no frame looks for one at most kReach spans to either side. Only
// where more than that many phonemes in a row are about as short as a frame do the shares differ
// from assign_frames': then it stays without.
class StreamShares {
public:
  static constexpr std::int64_t kReach = 4;

  explicit StreamShares(double rate_hz) : rate_hz_(rate_hz) {}

  // The next span; it starts where the one before ends.
  void push(const TimeSpan& span);

  // No further span comes: all shares are final.
  void finish();

  // The frames of the first span that has not been taken yet, where they are final.
  std::optional<FrameRange> take();

  // Spans that have been pushed and not been taken.
  std::size_t pending_count() const { return spans_.size(); }

private:
  std::int64_t count() const { return static_cast<std::int64_t>(spans_.size()); }
  std::int64_t frames(std::int64_t span) const;
  std::int64_t spare(std::int64_t span) const;
  double duration_s(std::int64_t span) const;
  void fill_empty_spans();
  bool fill(std::int64_t empty);
  void take_from_left(std::int64_t donor, std::int64_t empty);
  void take_from_right(std::int64_t donor, std::int64_t empty);
  bool first_is_final() const;

  double rate_hz_;
  bool finished_ = false;
  std::deque<TimeSpan> spans_;      // not taken yet
  std::deque<std::int64_t> bounds_; // #spans + 1, in frames; empty before the first span
  std::int64_t next_ = 0;           // into spans_: before it, whoever was empty has been seen to
};

} // namespace phonomime
