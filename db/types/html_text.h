// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace phonomime {

// RFC 4648, with padding.
std::string base64(std::string_view bytes);

// A text as it may stand between tags or in a quoted attribute.
std::string escape_html(std::string_view text);

// JSON that may stand inside a script element: no "</script>", no "<!--".
std::string script_safe(std::string_view json);

// Puts `content` in the place of the first `slot` of a page. Throws InternalError where there is
// none.
void fill_slot(std::string& page, std::string_view slot, std::string_view content);

} // namespace phonomime
