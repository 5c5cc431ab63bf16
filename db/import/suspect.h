// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/gaps.h"
#include "db/import/log_histogram.h"
#include "db/import/recording.h"
#include "db/types/imported_sentence.h"
#include "db/types/layout.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace phonomime {

// Why a node may be bad.
enum class SuspectReason { gap, jump, frozen, duration };
inline constexpr std::array<std::string_view, 4> kSuspectReasonNames = {"gap", "jump", "frozen",
                                                                        "duration"};

// What is usual in a corpus: the measure of the unusual.
struct UsualMotion {
  std::vector<LogHistogram> speeds;              // by group, mm/s (head still) or 1/s
  std::map<std::string, LogHistogram> durations; // by phoneme, seconds
  void add(const UsualMotion& other);
};

// The limits that follow, robust against the very faults they are for.
struct SuspectLimits {
  std::vector<double> speed; // by group, mm/s or 1/s: three times what 99 % of its steps stay
                             // under, at least 100 mm/s or 10/s
  std::map<std::string, std::pair<double, double>> duration_s; // least and most by phoneme: 5 sigma
                                                               // about the median of the logarithm,
                                                               // where the corpus has it 20 times
};
SuspectLimits suspect_limits(const UsualMotion& usual, LayoutKind kind);

// Distance of each group to the frame before, times the rate: (#frames - 1) by #groups, mm/s or
// 1/s; NaN where either is missing. `frames` is #frames by #channels, head still.
FrameMatrixD group_speeds(const FrameMatrixD& frames, int channels_per_group, double rate_hz);

// Runs of recorded frames.
struct FrozenRun {
  int group = -1; // -1: all that are present
  Eigen::Index first_frame = 0;
  Eigen::Index frame_count = 0;
};

// Groups that keep exactly one value over at least 0.2 s and 5 frames. Markers are looked at one by
// one (a marker of a living face is never still); weights only all together, for one alone may well
// rest. `frames` as recorded, head motion on, NaN = missing.
std::vector<FrozenRun> frozen_runs(const FrameMatrixD& frames, int channels_per_group,
                                   double rate_hz);

// What a sentence's nodes are judged by; times are the recording's own.
struct SuspectEvidence {
  const RecordedSentence* recorded = nullptr;
  const FrameMatrixD* speeds = nullptr; // group_speeds of the recorded frames
  const std::vector<Gap>* gaps = nullptr;
  double rate_hz = 0.0; // of the nodes' frames
};

// Writes to each node why it is suspect ("jump: lm14 at 1.24 s, 812 mm/s") and returns how many
// nodes each reason marks.
std::array<std::int64_t, 4> mark_suspects(std::vector<ImportedNode>& nodes,
                                          const SuspectEvidence& evidence,
                                          const SuspectLimits& limits, const Layout& layout);

} // namespace phonomime
