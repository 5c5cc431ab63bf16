// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/placement.h"

#include "db/types/errors.h"

#include <cmath>

#include <Eigen/Geometry>

namespace phonomime {

Points Similarity::apply(const Points& points) const {
  Points moved = (scale * points) * rotation.transpose();
  moved.rowwise() += translation.transpose();
  return moved;
}

Similarity fit_similarity(const Points& from, const Points& to) {
  if (from.rows() != to.rows() || from.rows() < 3) {
    throw InternalError({.what = "a similarity needs at least 3 pairs of points",
                         .got = std::to_string(from.rows()) + " and " + std::to_string(to.rows())});
  }
  const Eigen::Matrix4d fitted = Eigen::umeyama(from.transpose(), to.transpose(), true);
  Similarity similarity;
  similarity.scale = std::cbrt(fitted.topLeftCorner<3, 3>().determinant());
  if (similarity.scale > 0.0) {
    similarity.rotation = fitted.topLeftCorner<3, 3>() / similarity.scale;
  }
  similarity.translation = fitted.topRightCorner<3, 1>();
  similarity.rms = std::sqrt((similarity.apply(from) - to).rowwise().squaredNorm().mean());
  return similarity;
}

} // namespace phonomime
