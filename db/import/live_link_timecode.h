// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace phonomime {

// HH:MM:SS:FF.mmm, FF counting ticks inside the second.
struct Timecode {
  int second_of_day = 0;
  double ticks = 0.0;
  double resolution_ticks = 1.0; // of the last digit as written
};

// Nothing where the text is not a timecode.
std::optional<Timecode> parse_timecode(std::string_view text);

// How many ticks make a second. Live Link Face counts in 60ths at any frame rate; another count
// (24, 25, 30, 50) is believed only where, over at least two changes of the second, the ticks stay
// below it and it leaves fewer than half of the dropped frames that 60 would mean.
double ticks_per_second(std::span<const Timecode> timecodes);

// Seconds since the first timecode; over midnight too.
std::vector<double> elapsed_s(std::span<const Timecode> timecodes, double ticks_per_second);

} // namespace phonomime
