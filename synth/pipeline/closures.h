// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"

#include <optional>

namespace phonomime {

// Whether the lips close in a node as it was recorded (DESIGN section 2): the smallest aperture
// over its frames, from the E11 reconstruction, is under 1.5 mm. Nothing where the layout cannot
// say.
std::optional<bool> recorded_closed(const MotionTable& table, NodeIndex node);

// Whether a phoneme asks for closed lips: its viseme is that of /p b m/.
bool asks_for_closure(const Phoneme& phoneme);

} // namespace phonomime
