// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// Why a node may be bad, as a mark's `reason`. The first two are found in the recordings while they
// are imported, for the stored frames no longer show them: a gap too long to fill, markers that
// keep exactly one place. The others (and stillness again) are found in the stored channels.
namespace suspect {
inline constexpr std::string_view kGap = "gap";
inline constexpr std::string_view kFrozen = "frozen";
inline constexpr std::string_view kSwapped = "swapped";
inline constexpr std::string_view kJump = "jump";
inline constexpr std::string_view kDrift = "drift";
inline constexpr std::string_view kNeighbours = "neighbours";
inline constexpr std::string_view kPose = "pose";
inline constexpr std::string_view kDuration = "duration";
} // namespace suspect
inline constexpr std::array kSuspectReasons = {
    suspect::kGap,   suspect::kFrozen,     suspect::kSwapped, suspect::kJump,
    suspect::kDrift, suspect::kNeighbours, suspect::kPose,    suspect::kDuration};

// Where a mark is from: suspects of the channels are judged anew when a corpus is added, those of
// the recordings stay.
enum class SuspectOrigin { recording, channels };

// One reason why one motion node may be bad.
struct SuspectMark {
  std::string reason; // of kSuspectReasons
  SuspectOrigin origin = SuspectOrigin::channels;
  double score = 1.0;              // times the limit; 1 at least
  std::int32_t first_frame = 0;    // of the sentence: where the fault is,
  std::int32_t frame_count = 0;    // which may be more than the node's own frames
  std::vector<std::string> groups; // whose fault it is; empty: of the whole face
  std::string text;                // for people, with the numbers
  bool operator==(const SuspectMark&) const = default;
};

} // namespace phonomime
