// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/surroundings.h"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace phonomime {

// What distinguishes one phoneme from the same one elsewhere.
struct PhonemeContext {
  std::int32_t emotion = 0;
  Surroundings surroundings;
};

// The motion of one phoneme as its context lets expect it: shrunken means of residuals, stage by
// stage. A stage parts all examples by some of the context (the neighbour before, the one after,
// the duration, both neighbours, ...), the whole of it in the end. Each part's mean residual, as if
// kPrior examples more had none, is taken off and passed on to the next stage. A context that was
// never recorded adds nothing, so that wider ones answer for it.
class ExpectedMotion {
public:
  static constexpr double kPrior = 8.0;

  // One record of `size` numbers and one context an example; at least one.
  ExpectedMotion(std::span<const float* const> records, std::size_t size,
                 std::span<const PhonemeContext> contexts);

  // The sum of what the stages expect: `size` numbers.
  std::vector<double> in(const PhonemeContext& context) const;

private:
  static constexpr std::size_t kStages = 9;
  using Key = std::array<std::int32_t, 5>;
  static Key key_of(const PhonemeContext& context, std::size_t stage);

  std::size_t size_;
  std::array<std::map<Key, std::vector<double>>, kStages> stages_;
};

} // namespace phonomime
