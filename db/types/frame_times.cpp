// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/frame_times.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace phonomime {
namespace {

double slack_in_frames(double position) {
  return 1e-9 * std::max(1.0, std::abs(position));
}

// Boundaries between spans in frames, and who may give a frame away.
class FrameShares {
public:
  FrameShares(std::span<const TimeSpan> spans, double rate_hz) : spans_(spans) {
    for (const TimeSpan& span : spans) {
      bounds_.push_back(first_frame_at(span.start_s, rate_hz));
    }
    bounds_.push_back(first_frame_at(spans.back().end_s, rate_hz));
    for (std::size_t i = 0; i < spans.size(); ++i) {
      spare_ += std::max<std::int64_t>(0, count(i) - (spans[i].needs_frame ? 1 : 0));
    }
  }

  std::int64_t count(std::size_t span) const { return bounds_[span + 1] - bounds_[span]; }
  std::int64_t first(std::size_t span) const { return bounds_[span]; }

  // Gives an empty span a frame of the nearest span that can spare one.
  void fill(std::size_t empty) {
    if (spare_ == 0) {
      return;
    }
    const std::size_t left = spare_on_the_left(empty);
    const std::size_t right = spare_on_the_right(empty);
    const bool has_left = left < empty;
    const bool has_right = right < spans_.size();
    if (has_left && (!has_right || prefers_left(left, empty, right))) {
      for (std::size_t bound = left + 1; bound <= empty; ++bound) {
        --bounds_[bound];
      }
    } else {
      for (std::size_t bound = empty + 1; bound <= right; ++bound) {
        ++bounds_[bound];
      }
    }
    --spare_;
  }

private:
  bool can_spare(std::size_t span) const {
    return count(span) > (spans_[span].needs_frame ? 1 : 0);
  }

  // `empty` itself where there is none.
  std::size_t spare_on_the_left(std::size_t empty) const {
    for (std::size_t i = empty; i > 0; --i) {
      if (can_spare(i - 1)) {
        return i - 1;
      }
    }
    return empty;
  }

  // #spans where there is none.
  std::size_t spare_on_the_right(std::size_t empty) const {
    std::size_t i = empty + 1;
    while (i < spans_.size() && !can_spare(i)) {
      ++i;
    }
    return i;
  }

  bool prefers_left(std::size_t left, std::size_t empty, std::size_t right) const {
    if (empty - left != right - empty) {
      return empty - left < right - empty;
    }
    const double left_s = spans_[left].end_s - spans_[left].start_s;
    const double right_s = spans_[right].end_s - spans_[right].start_s;
    return right_s <= left_s + 1e-9;
  }

  std::span<const TimeSpan> spans_;
  std::vector<std::int64_t> bounds_; // #spans + 1
  std::int64_t spare_ = 0;
};

} // namespace

std::int64_t first_frame_at(double time_s, double rate_hz) {
  const double position = time_s * rate_hz;
  return static_cast<std::int64_t>(std::ceil(position - slack_in_frames(position)));
}

std::int64_t frame_count_to(double end_s, double rate_hz) {
  const double position = end_s * rate_hz;
  return std::max<std::int64_t>(
      0, static_cast<std::int64_t>(std::floor(position + slack_in_frames(position))) + 1);
}

std::vector<FrameRange> assign_frames(std::span<const TimeSpan> spans, double rate_hz) {
  if (spans.empty()) {
    return {};
  }
  FrameShares shares(spans, rate_hz);
  for (std::size_t i = 0; i < spans.size(); ++i) {
    if (spans[i].needs_frame && shares.count(i) == 0) {
      shares.fill(i);
    }
  }
  std::vector<FrameRange> ranges;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    ranges.push_back({shares.first(i), shares.count(i)});
  }
  return ranges;
}

} // namespace phonomime
