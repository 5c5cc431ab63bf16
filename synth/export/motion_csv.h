// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"

#include <cstdint>
#include <string>

namespace phonomime {

// Motion as text that the importer's readers, spreadsheets and scripts read
// (corpora_schema/motion.md). `motion` is taken through E11; its frames are at k / rate.

// `time,<group>_x,<group>_y,<group>_z,...`, seconds and mm to four decimals, in our axes. `head`:
// whether the motion's head poses are put back; without them the head rests.
std::string marker_csv(const Layout& layout, const PcaModel& pca, const CoefficientMotion& motion,
                       bool head);

// `time,<name>,...`, weights to six decimals.
std::string weight_csv(const Layout& layout, const PcaModel& pca, const CoefficientMotion& motion);

// Whether every group of a weights layout is one of Live Link Face's 61 columns and the 52 shapes
// are all there.
bool is_live_link_layout(const Layout& layout);

// Live Link Face's 63 columns: Timecode, BlendshapeCount, the 52 shapes, head and eye angles (0
// where the layout has no such group); shapes stay within [0, 1]. Timecodes count 60 ticks a second
// from 00:00:00:00.000, with the fraction of a tick in thousandths. Throws InternalError for
// another layout.
std::string live_link_csv(const Layout& layout, const PcaModel& pca,
                          const CoefficientMotion& motion);

// The kind that suits the layout, in parts, for motion that comes bit by bit: markers as
// marker_csv, weights as live_link_csv where they can be, else as weight_csv.
std::string motion_csv_header(const Layout& layout);

// Its rows: `motion` goes on at frame `first_frame` of the whole.
std::string motion_csv_rows(const Layout& layout, const PcaModel& pca,
                            const CoefficientMotion& motion, bool head, std::int64_t first_frame);

} // namespace phonomime
