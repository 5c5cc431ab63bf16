// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/closures.h"

#include "db/types/lip_measures.h"

#include <algorithm>
#include <array>

namespace phonomime {

std::optional<bool> recorded_closed(const MotionTable& table, NodeIndex node) {
  const LipMeasures measures(table.layout);
  const auto frames = table.node_frames(node);
  bool closed = false;
  for (Eigen::Index f = 0; f < frames.rows(); ++f) {
    const Eigen::VectorXd channels =
        table.pca.reconstruct(frames.row(f).transpose().cast<double>());
    const std::optional<double> aperture =
        measures.aperture_mm({channels.data(), static_cast<std::size_t>(channels.size())});
    if (!aperture) {
      return std::nullopt;
    }
    closed = closed || *aperture < kClosedAperture_mm;
  }
  return closed;
}

bool asks_for_closure(const Phoneme& phoneme) {
  constexpr std::array<std::string_view, 3> kBilabials = {"p", "b", "m"};
  return std::ranges::find(kBilabials, phoneme.name) != kBilabials.end();
}

} // namespace phonomime
