// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "synth/style/style_stack.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace phonomime {

// What a cross-validation tries. A translation is judged by the rows of y that an output takes.
struct ChoiceOptions {
  std::vector<Eigen::Index> content_sizes; // J; empty: a range up to what the data have
  std::vector<double> ridges;              // variances of y; empty: a range by the data's spectrum
  Eigen::Index first_row = 0;              // of each style's vector: judged from here ...
  Eigen::Index row_count = 0;              // ... so many; 0: all from first_row on
  int threads = 0;                         // 0: as many as there are
};

// One J and ridge, and how far it is off on speech that it has not seen.
struct Choice {
  Eigen::Index content_size = 0;
  double ridge = 0.0;
  // Root mean square, a number of y, over all frames and all pairs of different styles.
  double error = 0.0;
};

struct ChosenDimensions {
  Choice best;               // of least error, ties to fewer dimensions, then the greater ridge
  std::vector<Choice> tried; // in order of J, then ridge
  // The same for no change and for adding the mean difference of the two styles.
  double unchanged_error = 0.0, mean_difference_error = 0.0;
};

// J and the ridge of the asymmetric model by leaving out one part at a time: the rest is fitted,
// the part is translated from each style to each other. `parts`: at least two, sentences of one
// part together in none of the others. Throws InputError (fewer than two parts, sizes that the data
// do not have) and Interrupted.
ChosenDimensions choose_dimensions(std::span<const StackSummary> parts,
                                   const ChoiceOptions& options, const Progress& progress = {});

} // namespace phonomime
