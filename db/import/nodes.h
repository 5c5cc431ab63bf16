// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/imported_sentence.h"

#include <string_view>
#include <vector>

namespace phonomime {

// The nodes of a sentence: each row outside silence, in order, with the frames that assign_frames
// gives it (DESIGN 11), at least one. `rows` follow on one another from 0 without holes. Throws
// InputError, with `where`, where there are fewer frames than phonemes.
std::vector<ImportedNode> cut_into_nodes(const std::vector<TimedPhoneme>& rows, double rate_hz,
                                         std::string_view where);

} // namespace phonomime
