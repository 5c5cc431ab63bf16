// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/triangle_mesh.h"

#include <vector>

namespace phonomime {

// A small rigid motion, linear in what it is fitted to: a point x goes to
// x + translation + rotation x (x - pivot).
struct SmallMotion {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero(); // rad, axis times angle
};

// The rigid motion of the lower jaw from the markers on it: least squares, the rotation linearised
// so that the motion stays linear in the markers (and in PCA coefficients: it can be a morph
// target). With fewer than 3 markers, or markers in a line, the translation alone.
class JawMotion {
public:
  JawMotion() = default;
  // `rest`: #markers by 3, mm.
  explicit JawMotion(const Points& rest);

  bool empty() const { return count_ == 0; }

  // `displacements`: #markers by 3, mm.
  SmallMotion fit(const Points& displacements) const;

  // Displacement of a point at `rest`.
  Eigen::RowVector3d displacement(const SmallMotion& motion, const Eigen::RowVector3d& rest) const;

private:
  Eigen::Index count_ = 0;
  Eigen::Vector3d pivot_ = Eigen::Vector3d::Zero(); // the markers' mean
  Points arms_;                                     // rest - pivot
  Eigen::Matrix3d inverse_inertia_ = Eigen::Matrix3d::Zero();
};

} // namespace phonomime
