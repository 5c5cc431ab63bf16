// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace phonomime {

// The HTML player's page as it was built (synth/export/player), or nothing in a build without it.
std::string_view player_template();

} // namespace phonomime
