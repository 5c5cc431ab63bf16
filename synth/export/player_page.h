// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace phonomime {

// The page that synth/export/player makes when Phonomime is built, inside the program; empty where
// it was built without node and npm.
std::string_view player_page();

} // namespace phonomime
