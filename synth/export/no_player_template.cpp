// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/player_template.h"

namespace phonomime {

std::string_view player_template() {
  return {};
}

} // namespace phonomime
