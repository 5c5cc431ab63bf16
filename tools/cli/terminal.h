// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"

#include <string_view>

namespace phonomime {

// Progress as a line on stderr that renews itself, where stderr is a terminal and `quiet` is not
// asked for; silent else. Its stop flag is set by Ctrl-C (SIGINT) and SIGTERM.
Progress terminal_progress(bool quiet);

// Wipes the progress line, if there is one.
void clear_progress();

// Data on stdout. Throws IoError where it cannot be written.
void print(std::string_view text);

// A message on stderr, one line.
void print_message(std::string_view text);

} // namespace phonomime
