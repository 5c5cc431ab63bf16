// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"

#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// A recording in the layout's channels.
struct LayoutMotion {
  double rate_hz = 0.0;
  FrameMatrixD frames; // #frames by #channels, mm in our axes or weights; NaN = missing
  std::vector<std::string> extra_groups; // that the layout does not have, in the file's order
};

// Puts a clip's groups into the layout's order, unit and axes; groups are found by their names.
// Throws InputError, with `where`: no frames, a rate that is not positive, weights where the layout
// has markers or the reverse, a group that the file does not have or has twice, a unit that the
// file says and that is not the layout's.
LayoutMotion to_layout(const MotionClip& clip, const Layout& layout, std::string_view where);

} // namespace phonomime
