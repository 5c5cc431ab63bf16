// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

namespace phonomime {

// The regular file that a corpus names by a path relative to its folder (canonical already). Throws
// InputError, with `where` (the line that names it): an absolute path, a `..`, a link that leads
// out of the folder, not a file; and IoError where there is no such file or it cannot be reached.
std::filesystem::path path_in_corpus(const std::filesystem::path& folder, std::string_view named,
                                     std::string_view where);

} // namespace phonomime
