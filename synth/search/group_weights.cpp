// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/group_weights.h"

namespace phonomime {

Eigen::MatrixXd weighted_basis(const MotionTable& table, const CostWeights& weights) {
  Eigen::MatrixXd basis = table.pca.basis;
  if (weights.off_lips == 1.0 || table.layout.groups_in(Region::lips).empty()) {
    return basis;
  }
  const int axes = table.layout.channels_per_group();
  for (int group = 0; group < table.layout.group_count(); ++group) {
    if (!table.layout.groups[static_cast<std::size_t>(group)].in(Region::lips)) {
      basis.middleRows(axes * group, axes) *= weights.off_lips;
    }
  }
  return basis;
}

} // namespace phonomime
