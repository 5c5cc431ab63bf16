// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "synth/style/style_stack.h"

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace phonomime {

// What a cross-validation of the symmetric model tries. A window is frames in a row that share a
// style which nobody names.
struct UnknownChoiceOptions {
  std::vector<Eigen::Index> style_sizes;   // I; empty: 2 to the number of styles
  std::vector<Eigen::Index> content_sizes; // J; empty: a range up to what the data have
  Eigen::Index window = 30;                // frames
  Eigen::Index most_windows = 8;           // of a part, spread evenly over its columns
  int threads = 0;                         // 0: as many as there are
};

// One I and J, and what became of windows that the model had not seen.
struct UnknownChoice {
  Eigen::Index style_size = 0, content_size = 0;
  std::int64_t found = 0, windows = 0; // whose style was found, of how many
  // Root mean square, a number of y: what every style was to show of the windows, with the
  // contents that went with the style inferred.
  double error = 0.0;
};

struct ChosenUnknown {
  UnknownChoice best;               // the most found, ties to the least error, then to fewer
                                    // dimensions of style, then of content
  std::vector<UnknownChoice> tried; // in order of I, then J
};

// I and J of the symmetric model by leaving out one part at a time: the rest is fitted, the style
// of the part's windows inferred, each shown in every style. `parts` and `summaries`: the same
// parts, at least two. Throws InputError (fewer than two parts, sizes that the data do not have)
// and Interrupted.
ChosenUnknown choose_unknown(std::span<const StyleStack> parts,
                             std::span<const StackSummary> summaries,
                             const UnknownChoiceOptions& options, const Progress& progress = {});

} // namespace phonomime
