// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/recorded_faults.h"

#include "db/curation/still_runs.h"
#include "db/curation/suspect_marks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace phonomime {

namespace {

// Recorded frames that a node draws on, as a half-open range of positions in frames.
struct RecordedRange {
  double first = 0.0;
  double last = 0.0;
  bool meets(Eigen::Index from, Eigen::Index count) const {
    constexpr double kRounding = 1e-6;
    return static_cast<double>(from + count - 1) > first - 1.0 + kRounding &&
           static_cast<double>(from) < last + 1.0 - kRounding;
  }
};

class Marker {
public:
  Marker(const RecordedSentence& recorded, const Layout& layout, double rate_hz)
      : clock_(recorded.clock), layout_(layout), rate_hz_(rate_hz) {}

  RecordedRange range_of(const ImportedNode& node) const {
    const auto position = [&](std::int32_t frame) {
      return (frame / rate_hz_ - clock_.start_s) * clock_.rate_hz;
    };
    // A new frame of a lower rate draws on the recorded frames of its duration (resample_marks).
    const double reach = clock_.rate_hz > rate_hz_ ? clock_.rate_hz / rate_hz_ : 0.0;
    return {position(node.first_frame) - reach,
            position(node.first_frame + node.frame_count - 1) + reach};
  }

  // A run of recorded frames as one of stored frames.
  RunPlace place(Eigen::Index first, Eigen::Index count) const {
    const auto stored = [&](Eigen::Index frame) {
      const double time_s = clock_.start_s + static_cast<double>(frame) / clock_.rate_hz;
      return std::max(std::int32_t{0}, static_cast<std::int32_t>(std::lround(time_s * rate_hz_)));
    };
    const std::int32_t from = stored(first);
    return {.rate_hz = clock_.rate_hz,
            .start_s = clock_.start_s,
            .first_frame = from,
            .frame_count = std::max(std::int32_t{1}, stored(first + count) - from)};
  }

  SuspectMark gap_mark(const Gap& gap, std::size_t others) const {
    const RunPlace where = place(gap.first_frame, gap.frame_count);
    const double missing_s = static_cast<double>(gap.frame_count) / clock_.rate_hz;
    const std::string& name = layout_.groups[static_cast<std::size_t>(gap.group)].name;
    return {.reason = std::string(suspect::kGap),
            .origin = SuspectOrigin::recording,
            .score = std::max(1.0, missing_s / kUsualGap_s),
            .first_frame = where.first_frame,
            .frame_count = where.frame_count,
            .groups = {name},
            .text = fmt::format(
                "gap: {}{} missing from {:.2f} s for {:.2f} s", name,
                others == 0 ? "" : fmt::format(" and {} more", others),
                clock_.start_s + static_cast<double>(gap.first_frame) / clock_.rate_hz, missing_s)};
  }

  SuspectMark still_mark(const StillRun& run, std::size_t others) const {
    RunPlace where = place(run.first_frame, run.frame_count);
    where.others = others;
    return frozen_mark(run, SuspectOrigin::recording, layout_, where);
  }

private:
  static constexpr double kUsualGap_s = 0.1; // the length that a score counts in

  const SourceClock clock_;
  const Layout& layout_;
  double rate_hz_ = 0.0;
};

} // namespace

void mark_recorded_faults(std::vector<ImportedNode>& nodes, const RecordedSentence& recorded,
                          const std::vector<Gap>& gaps, const Layout& layout, double rate_hz) {
  const std::vector<StillRun> still =
      still_runs(recorded.frames, layout, recorded.clock.rate_hz, StillLimits{});
  const Marker marker(recorded, layout, rate_hz);
  for (ImportedNode& node : nodes) {
    const RecordedRange range = marker.range_of(node);
    const auto is_marked = [&](const Gap& gap) {
      return gap.action == GapAction::marked && range.meets(gap.first_frame, gap.frame_count);
    };
    const auto is_still = [&](const StillRun& run) {
      return range.meets(run.first_frame, run.frame_count);
    };
    const auto gap_count = static_cast<std::size_t>(std::ranges::count_if(gaps, is_marked));
    const auto still_count = static_cast<std::size_t>(std::ranges::count_if(still, is_still));
    for (const Gap& gap : gaps) {
      if (is_marked(gap)) {
        add_mark(node.suspect, marker.gap_mark(gap, gap_count - 1));
      }
    }
    for (const StillRun& run : still) {
      if (is_still(run)) {
        add_mark(node.suspect, marker.still_mark(run, still_count - 1));
      }
    }
  }
}

} // namespace phonomime
