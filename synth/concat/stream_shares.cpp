// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/stream_shares.h"

#include <algorithm>

namespace phonomime {

namespace {
constexpr double kSameDuration_s = 1e-9; // as assign_frames
}

void StreamShares::push(const TimeSpan& span) {
  if (bounds_.empty()) {
    bounds_.push_back(first_frame_at(span.start_s, rate_hz_));
  }
  spans_.push_back(span);
  bounds_.push_back(first_frame_at(span.end_s, rate_hz_));
  fill_empty_spans();
}

void StreamShares::finish() {
  finished_ = true;
  fill_empty_spans();
}

std::optional<FrameRange> StreamShares::take() {
  if (spans_.empty() || !first_is_final()) {
    return std::nullopt;
  }
  const FrameRange range{bounds_[0], frames(0)};
  spans_.pop_front();
  bounds_.pop_front();
  --next_;
  return range;
}

std::int64_t StreamShares::frames(std::int64_t span) const {
  const auto i = static_cast<std::size_t>(span);
  return bounds_[i + 1] - bounds_[i];
}

std::int64_t StreamShares::spare(std::int64_t span) const {
  const bool keeps_one = spans_[static_cast<std::size_t>(span)].needs_frame;
  return std::max<std::int64_t>(0, frames(span) - (keeps_one ? 1 : 0));
}

double StreamShares::duration_s(std::int64_t span) const {
  const TimeSpan& times = spans_[static_cast<std::size_t>(span)];
  return times.end_s - times.start_s;
}

void StreamShares::fill_empty_spans() {
  while (next_ < count()) {
    const bool empty = spans_[static_cast<std::size_t>(next_)].needs_frame && frames(next_) == 0;
    if (empty && !fill(next_)) {
      return;
    }
    ++next_;
  }
}

// False where a span that has not come yet may have a say.
bool StreamShares::fill(std::int64_t empty) {
  for (std::int64_t distance = 1; distance <= kReach; ++distance) {
    const std::int64_t left = empty - distance;
    const std::int64_t right = empty + distance;
    if (right >= count() && !finished_) {
      return false;
    }
    const bool has_left = left >= 0 && spare(left) > 0;
    const bool has_right = right < count() && spare(right) > 0;
    if (has_left && (!has_right || duration_s(right) <= duration_s(left) + kSameDuration_s)) {
      take_from_left(left, empty);
      return true;
    }
    if (has_right) {
      take_from_right(right, empty);
      return true;
    }
  }
  return true;
}

void StreamShares::take_from_left(std::int64_t donor, std::int64_t empty) {
  for (std::int64_t bound = donor + 1; bound <= empty; ++bound) {
    --bounds_[static_cast<std::size_t>(bound)];
  }
}

void StreamShares::take_from_right(std::int64_t donor, std::int64_t empty) {
  for (std::int64_t bound = empty + 1; bound <= donor; ++bound) {
    ++bounds_[static_cast<std::size_t>(bound)];
  }
}

// Whether everyone within reach who is or may be empty finds a frame that is nearer. Each takes at
// most one, and nobody beyond reach is served before them.
bool StreamShares::first_is_final() const {
  if (next_ == 0) {
    return false;
  }
  std::int64_t nearer = 0;
  for (std::int64_t i = 1; i <= kReach; ++i) {
    if (i >= count() && finished_) {
      return true;
    }
    const bool known = i < count();
    const bool may_take =
        !known || (i >= next_ && spans_[static_cast<std::size_t>(i)].needs_frame && frames(i) == 0);
    if (may_take && nearer == 0) {
      return false;
    }
    nearer += may_take ? -1 : spare(i);
  }
  return true;
}

} // namespace phonomime
