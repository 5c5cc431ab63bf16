// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/held_out.h"
#include "tools/app/synth.h"
#include "tools/evaluate/aggregate.h"
#include "tools/evaluate/method.h"
#include "tools/evaluate/table_part.h"

#include <array>
#include <cstdint>
#include <vector>

namespace phonomime {

// How the quality of one method grows with the recordings that it has: held-out sentences are
// spoken with growing random parts of the sentences (the smaller ones within the larger), with the
// PCA and the reference pose of all of them.
class SizeStudy {
public:
  SizeStudy(const MethodEntry& method, std::uint64_t seed) : method_(method), seed_(seed) {}

  // Of each fold once. Throws what speak_held_out does.
  void add(const HeldOut& held_out, const SynthOptions& options, const Progress& progress);

  // From the smallest part to all; sentences and nodes are means over the folds.
  std::vector<SizePoint> points();

private:
  static constexpr std::array<int, 6> kParts = {32, 16, 8, 4, 2, 1}; // one in so many
  struct Part {
    std::int64_t sentences = 0, nodes = 0;
    ContextCoverage coverage;
    double search_s = 0.0;
    std::vector<SentenceMeasures> measures;
  };

  MethodEntry method_;
  std::uint64_t seed_;
  std::int64_t folds_ = 0;
  std::array<Part, kParts.size()> parts_;
};

} // namespace phonomime
