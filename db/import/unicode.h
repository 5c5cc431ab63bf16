// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace phonomime {

// The bytes of a text file as UTF-8 without a byte order mark: UTF-16 (either order, with its mark)
// is converted, UTF-8 checked. Throws InputError where it is neither.
std::string decode_text(std::string_view bytes, std::string_view where);

} // namespace phonomime
