// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/jaw_motion.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace phonomime {

JawMotion::JawMotion(const Points& rest) : count_(rest.rows()) {
  if (count_ == 0) {
    return;
  }
  pivot_ = rest.colwise().mean().transpose();
  arms_ = rest.rowwise() - pivot_.transpose();
  const Eigen::Matrix3d scatter = arms_.transpose() * arms_;
  const Eigen::Matrix3d inertia = scatter.trace() * Eigen::Matrix3d::Identity() - scatter;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(inertia);
  // A line of markers has one axis without inertia: its rotation cannot be seen.
  if (count_ >= 3 && eigen.eigenvalues()(0) > 1e-3 * eigen.eigenvalues()(2)) {
    inverse_inertia_ = inertia.inverse();
  }
}

SmallMotion JawMotion::fit(const Points& displacements) const {
  SmallMotion motion;
  motion.translation = displacements.colwise().mean().transpose();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < count_; ++i) {
    moment += arms_.row(i).cross(displacements.row(i)).transpose();
  }
  motion.rotation = inverse_inertia_ * moment;
  return motion;
}

Eigen::RowVector3d JawMotion::displacement(const SmallMotion& motion,
                                           const Eigen::RowVector3d& rest) const {
  return (motion.translation + motion.rotation.cross(rest.transpose() - pivot_)).transpose();
}

} // namespace phonomime
