// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/search_types.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// A weight of the cost that can be tuned, and where its values are looked for: between `least` and
// `most`, on a logarithmic scale.
struct TunableWeight {
  std::string_view name; // as in a weights file
  double CostWeights::*member;
  double least, most;
  bool beyond_paper; // a term that the paper's cost does not have
  bool usual;        // tuned where no weight is named
};

// All but PNT, which is the database's own: with the others free it would only be a second name for
// them.
std::span<const TunableWeight> tunable_weights();

// The weights that are tuned, as a box: each side is a weight's range, 0 to 1.
class WeightSpace {
public:
  // `names`: which weights; empty: the usual ones that `model` has and that can make a difference.
  // `several_emotions`: whether alpha6 can. Throws UsageError for a name that is unknown, repeated,
  // or without any effect.
  WeightSpace(CostModel model, std::span<const std::string> names, bool several_emotions);

  std::size_t size() const { return weights_.size(); }
  std::span<const TunableWeight> weights() const { return weights_; }

  // Where weights lie in the box; those outside their range lie on its side.
  std::vector<double> point(const CostWeights& weights) const;

  // `base` with the weights of a point, rounded to three digits: so they are the same on every
  // machine, and can be read.
  CostWeights at(std::span<const double> point, const CostWeights& base) const;

private:
  std::vector<TunableWeight> weights_;
};

// The weights without PNT in one line of JSON: two sets are the same if and only if the lines are.
std::string weights_line(const CostWeights& weights);

// The weights of such a line, with PNT 0. Throws InputError.
CostWeights parse_weights_line(std::string_view line, std::string_view where);

} // namespace phonomime
