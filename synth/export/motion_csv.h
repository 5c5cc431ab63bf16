// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"

#include <span>
#include <string>

namespace phonomime {

// Marker CSV (DESIGN section 10): `time,<group>_x,<group>_y,<group>_z,...`, seconds to 1e-6 and
// millimetres to 1e-4, frame k at k / rate_hz. `channels`: #frames by #channels, head at rest.
// `head`: #frames poses to put back, or empty. Throws InternalError where sizes do not fit,
// UsageError where a group's name cannot stand in a CSV header.
std::string format_marker_csv(const Layout& layout, double rate_hz, const FrameMatrixD& channels,
                              std::span<const HeadPose> head = {});

// Weight CSV: Live Link Face's 63 columns where the layout's groups are ARKit's (its 52 shapes,
// with or without the 9 rotations of head and eyes; case ignored), else `time,<name>,...`.
// `weights`: #frames by #groups. A Live Link timecode counts 60 ticks a second from 00:00:00:00.000
// whatever the rate. Throws as format_marker_csv.
std::string format_weight_csv(const Layout& layout, double rate_hz, const FrameMatrixD& weights);

// Whether format_weight_csv writes Live Link's columns for this layout.
bool is_live_link_layout(const Layout& layout);

} // namespace phonomime
