// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/weight_solver.h"

#include <optional>

namespace phonomime {

// How a person wants weights to be solved for; what is not said is as the method has it.
struct WeightChoices {
  std::optional<double> largest, ridge, sparsity, smoothness;

  bool any() const { return largest || ridge || sparsity || smoothness; }
  // Throws UsageError that names the value.
  WeightOptions over(WeightOptions own) const {
    own.upper = largest.value_or(own.upper);
    own.ridge = ridge.value_or(own.ridge);
    own.sparsity = sparsity.value_or(own.sparsity);
    own.smoothness = smoothness.value_or(own.smoothness);
    own.validate();
    return own;
  }
};

} // namespace phonomime
