// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/region_errors.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

std::vector<RegionError> region_errors(const MarkerShapes& shapes, const Layout& layout,
                                       const FrameMatrixD& channels, const FrameMatrixD& weights) {
  const FrameMatrixD left =
      (channels.rowwise() - shapes.reference.transpose()) - weights * shapes.offsets.transpose();
  std::vector<RegionError> errors;
  for (std::size_t r = 0; r < kRegionNames.size(); ++r) {
    RegionError error{.region = static_cast<Region>(r)};
    double squares = 0.0;
    double count = 0.0;
    for (const int group : layout.groups_in(error.region)) {
      if (shapes.on_face[static_cast<std::size_t>(group)] == 0) {
        continue;
      }
      ++error.markers;
      for (Eigen::Index k = 0; k < left.rows(); ++k) {
        const double square = left.row(k).segment<3>(3 * group).squaredNorm();
        if (std::isfinite(square)) {
          squares += square;
          count += 1.0;
        }
      }
    }
    if (error.markers > 0) {
      error.rms_mm = std::sqrt(squares / std::max(count, 1.0));
      errors.push_back(error);
    }
  }
  return errors;
}

} // namespace phonomime
