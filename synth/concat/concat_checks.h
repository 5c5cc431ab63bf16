// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/concat/concatenate.h"

#include <cstddef>

namespace phonomime {

// What concatenate() and ConcatStream ask of their callers.

// Throws InternalError where the table does not fit itself or an option is out of range.
void check_concat_options(const MotionTable& table, const ConcatOptions& options);

// Of step `index`, which has to start at previous_end_s. Throws InternalError, and InputError where
// the motion would be longer than 10,000,000 frames.
void check_concat_step(const MotionTable& table, const ConcatStep& step, std::size_t index,
                       double previous_end_s);

} // namespace phonomime
