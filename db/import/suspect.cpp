// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/suspect.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr double kUsualShare = 0.99; // of the steps of a group
constexpr double kUnusualTimes = 3.0;
constexpr double kLeastMarkerLimit = 100.0; // mm/s
constexpr double kLeastWeightLimit = 10.0;  // 1/s
constexpr double kDurationSigmas = 5.0;
constexpr double kLeastDurationSigma = 0.2; // octaves
constexpr std::int64_t kLeastPhonemes = 20;
constexpr double kFrozen_s = 0.2;
constexpr Eigen::Index kFrozenFrames = 5;

// Recorded frames that a node draws on, as a half-open range of positions in frames.
struct RecordedRange {
  double first = 0.0;
  double last = 0.0;
  bool meets(Eigen::Index from, Eigen::Index to) const { // frames from .. to
    constexpr double kRounding = 1e-6;
    return static_cast<double>(to) > first - 1.0 + kRounding &&
           static_cast<double>(from) < last + 1.0 - kRounding;
  }
};

RecordedRange range_of(const ImportedNode& node, const SuspectEvidence& evidence) {
  const SourceClock& clock = evidence.recorded->clock;
  const auto position = [&](std::int32_t frame) {
    return (frame / evidence.rate_hz - clock.start_s) * clock.rate_hz;
  };
  // A new frame of a lower rate draws on the recorded frames of its duration (resample_marks).
  const double reach = clock.rate_hz > evidence.rate_hz ? clock.rate_hz / evidence.rate_hz : 0.0;
  return {position(node.first_frame) - reach,
          position(node.first_frame + node.frame_count - 1) + reach};
}

double time_of(Eigen::Index recorded_frame, const SuspectEvidence& evidence) {
  const SourceClock& clock = evidence.recorded->clock;
  return clock.start_s + static_cast<double>(recorded_frame) / clock.rate_hz;
}

std::string in_all(std::size_t others) {
  return others == 0 ? "" : fmt::format(" and {} more", others);
}

std::string group_name(const Layout& layout, int group) {
  return group < 0 ? "all groups" : layout.groups[static_cast<std::size_t>(group)].name;
}

std::string gap_reason(const RecordedRange& range, const SuspectEvidence& evidence,
                       const Layout& layout) {
  const Gap* first = nullptr;
  std::size_t others = 0;
  for (const Gap& gap : *evidence.gaps) {
    if (gap.action != GapAction::marked ||
        !range.meets(gap.first_frame, gap.first_frame + gap.frame_count - 1)) {
      continue;
    }
    others += first != nullptr;
    first = first != nullptr ? first : &gap;
  }
  return first == nullptr
             ? ""
             : fmt::format(
                   "gap: {}{} missing from {:.2f} s for {:.2f} s", group_name(layout, first->group),
                   in_all(others), time_of(first->first_frame, evidence),
                   static_cast<double>(first->frame_count) / evidence.recorded->clock.rate_hz);
}

std::string jump_reason(const RecordedRange& range, const SuspectEvidence& evidence,
                        const SuspectLimits& limits, const Layout& layout) {
  const FrameMatrixD& speeds = *evidence.speeds;
  double most_over = 1.0;
  Eigen::Index at = -1;
  Eigen::Index group = 0;
  std::size_t count = 0;
  for (Eigen::Index k = 0; k < speeds.rows(); ++k) {
    if (!range.meets(k, k + 1)) {
      continue;
    }
    for (Eigen::Index g = 0; g < speeds.cols(); ++g) {
      const double over = speeds(k, g) / limits.speed[static_cast<std::size_t>(g)];
      count += over > 1.0;
      if (over > most_over) {
        most_over = over;
        at = k;
        group = g;
      }
    }
  }
  return at < 0 ? ""
                : fmt::format("jump: {}{} at {:.2f} s, {:.3g} {}",
                              group_name(layout, static_cast<int>(group)), in_all(count - 1),
                              time_of(at, evidence), speeds(at, group),
                              layout.kind == LayoutKind::markers ? "mm/s" : "per second");
}

std::string frozen_reason(const RecordedRange& range, const SuspectEvidence& evidence,
                          const std::vector<FrozenRun>& runs, const Layout& layout) {
  const FrozenRun* first = nullptr;
  std::size_t others = 0;
  for (const FrozenRun& run : runs) {
    if (!range.meets(run.first_frame, run.first_frame + run.frame_count - 1)) {
      continue;
    }
    others += first != nullptr;
    first = first != nullptr ? first : &run;
  }
  return first == nullptr ? ""
                          : fmt::format("frozen: {}{} still from {:.2f} s for {:.2f} s",
                                        group_name(layout, first->group), in_all(others),
                                        time_of(first->first_frame, evidence),
                                        static_cast<double>(first->frame_count) /
                                            evidence.recorded->clock.rate_hz);
}

std::string duration_reason(const TimedPhoneme& row, const SuspectLimits& limits) {
  const auto usual = limits.duration_s.find(row.phoneme.name);
  const double duration_s = row.end_s - row.start_s;
  if (usual == limits.duration_s.end() ||
      (duration_s >= usual->second.first && duration_s <= usual->second.second)) {
    return "";
  }
  return fmt::format("duration: {} of {:.3g} s, usual {:.3g} s to {:.3g} s", row.phoneme.name,
                     duration_s, usual->second.first, usual->second.second);
}

} // namespace

void UsualMotion::add(const UsualMotion& other) {
  speeds.resize(std::max(speeds.size(), other.speeds.size()));
  for (std::size_t group = 0; group < other.speeds.size(); ++group) {
    speeds[group].add(other.speeds[group]);
  }
  for (const auto& [phoneme, histogram] : other.durations) {
    durations[phoneme].add(histogram);
  }
}

SuspectLimits suspect_limits(const UsualMotion& usual, LayoutKind kind) {
  const double least = kind == LayoutKind::markers ? kLeastMarkerLimit : kLeastWeightLimit;
  SuspectLimits limits;
  for (const LogHistogram& histogram : usual.speeds) {
    limits.speed.push_back(std::max(least, kUnusualTimes * histogram.quantile(kUsualShare)));
  }
  for (const auto& [phoneme, histogram] : usual.durations) {
    const LogSpread spread = histogram.spread();
    if (spread.count >= kLeastPhonemes) {
      const double reach = kDurationSigmas * std::max(kLeastDurationSigma, spread.sigma);
      limits.duration_s[phoneme] = {std::exp2(spread.median - reach),
                                    std::exp2(spread.median + reach)};
    }
  }
  return limits;
}

FrameMatrixD group_speeds(const FrameMatrixD& frames, int channels_per_group, double rate_hz) {
  const Eigen::Index steps = std::max<Eigen::Index>(0, frames.rows() - 1);
  const Eigen::Index group_count = frames.cols() / channels_per_group;
  FrameMatrixD speeds(steps, group_count);
  for (Eigen::Index k = 0; k < steps; ++k) {
    for (Eigen::Index group = 0; group < group_count; ++group) {
      const Eigen::Index column = group * channels_per_group;
      speeds(k, group) = rate_hz * (frames.row(k + 1).segment(column, channels_per_group) -
                                    frames.row(k).segment(column, channels_per_group))
                                       .norm();
    }
  }
  return speeds;
}

std::vector<FrozenRun> frozen_runs(const FrameMatrixD& frames, int channels_per_group,
                                   double rate_hz) {
  // Markers singly; weights as one group of all channels.
  const bool singly = channels_per_group == 3;
  const Eigen::Index width = singly ? channels_per_group : frames.cols();
  std::vector<FrozenRun> runs;
  for (Eigen::Index column = 0; column < frames.cols(); column += width) {
    Eigen::Index first = 0;
    for (Eigen::Index k = 1; k <= frames.rows(); ++k) {
      const bool same = k < frames.rows() && frames.row(k).segment(column, width) ==
                                                 frames.row(first).segment(column, width);
      if (same) {
        continue;
      }
      const Eigen::Index count = k - first;
      if (count >= kFrozenFrames && static_cast<double>(count) / rate_hz >= kFrozen_s) {
        runs.push_back({.group = singly ? static_cast<int>(column / width) : -1,
                        .first_frame = first,
                        .frame_count = count});
      }
      first = k;
    }
  }
  return runs;
}

std::array<std::int64_t, 4> mark_suspects(std::vector<ImportedNode>& nodes,
                                          const SuspectEvidence& evidence,
                                          const SuspectLimits& limits, const Layout& layout) {
  const std::vector<FrozenRun> runs = frozen_runs(
      evidence.recorded->frames, layout.channels_per_group(), evidence.recorded->clock.rate_hz);
  std::array<std::int64_t, 4> counts{};
  for (ImportedNode& node : nodes) {
    const RecordedRange range = range_of(node, evidence);
    const std::array<std::string, 4> reasons = {
        gap_reason(range, evidence, layout), jump_reason(range, evidence, limits, layout),
        frozen_reason(range, evidence, runs, layout),
        duration_reason(evidence.recorded->rows[static_cast<std::size_t>(node.row)], limits)};
    for (std::size_t reason = 0; reason < reasons.size(); ++reason) {
      if (!reasons[reason].empty()) {
        node.suspect.push_back(reasons[reason]);
        ++counts[reason];
      }
    }
  }
  return counts;
}

} // namespace phonomime
