// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace phonomime {

// One row of an alignment file: a phone label as written, half-open in time.
struct AlignedLabel {
  std::string label;
  double start_s = 0.0;
  double end_s = 0.0;
  long line = 0; // line of the file it comes from, for messages; 0 where unknown
};

// An alignment as a reader gives it: rows in order of time, none overlapping, none reversed. Time
// that it leaves out is silence (inserted later, see complete_with_silence).
struct Alignment {
  std::string source; // path, for messages
  std::vector<AlignedLabel> rows;
};

} // namespace phonomime
