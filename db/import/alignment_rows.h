// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/alignment.h"

#include <string_view>

namespace phonomime {

// Appends a row and keeps the promise of Alignment: times finite, not negative, a duration, no
// overlap with the row before (one of under a microsecond is rounding and is cut off). Throws
// InputError naming the row's line.
void append_row(Alignment& alignment, AlignedLabel row);

// Throws InputError where there are no rows.
void require_rows(const Alignment& alignment);

} // namespace phonomime
