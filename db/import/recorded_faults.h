// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/gaps.h"
#include "db/import/recording.h"
#include "db/types/imported_sentence.h"
#include "db/types/layout.h"

#include <vector>

namespace phonomime {

// Marks nodes where the recording shows what the stored frames no longer do: gaps that were too
// long to fill ("gap"), and groups that keep exactly one recorded place while those around them
// move ("frozen", still_runs; the head's motion, which is taken off later, would move them).
// `rate_hz` is that of the nodes' frames.
void mark_recorded_faults(std::vector<ImportedNode>& nodes, const RecordedSentence& recorded,
                          const std::vector<Gap>& gaps, const Layout& layout, double rate_hz);

} // namespace phonomime
