// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

// The files of this folder (schemas/*.json, migrations/*.sql, phoneme_sets/*.json) as they were at
// build time, so that the program needs no files beside it.
namespace phonomime::corpora_schema {

// The content of a file by its path in this folder. Throws std::out_of_range for an unknown path.
std::string_view embedded_file(std::string_view path);

// The paths that start with `folder`, in alphabetical order.
std::vector<std::string_view> embedded_files(std::string_view folder);

} // namespace phonomime::corpora_schema
