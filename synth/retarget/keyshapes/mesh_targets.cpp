// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/mesh_targets.h"

#include "db/types/errors.h"

#include <algorithm>

namespace phonomime {
namespace {

// The share of each vertex that follows a part: #vertices.
Eigen::VectorXd seam_shares(const Rig& rig, const std::string& part, const Points& rest) {
  if (!rig.seam || (part != "upper" && part != "lower")) {
    return Eigen::VectorXd::Ones(rest.rows());
  }
  const Eigen::ArrayXd upper =
      ((rest.col(1).array() - rig.seam->from) / (rig.seam->to - rig.seam->from)).max(0.0).min(1.0);
  if (part == "upper") {
    return upper.matrix();
  }
  return (1.0 - upper).matrix();
}

} // namespace

RigTargets mesh_targets(const Rig& rig, const TriangleMesh& rest,
                        const std::vector<TriangleMesh>& poses) {
  RigTargets targets;
  for (Eigen::Index v = 0; v < rest.positions.rows(); ++v) {
    for (const char* axis : {".x", ".y", ".z"}) {
      targets.names.push_back("vertex " + std::to_string(v) + axis);
    }
  }
  targets.values.resize(std::ssize(poses), rest.positions.size());
  std::size_t pose = 0;
  for (const RigSet& set : rig.sets) {
    const Eigen::VectorXd shares = seam_shares(rig, set.part, rest.positions);
    for (std::size_t i = 0; i < set.keyshapes.size(); ++i, ++pose) {
      if (pose >= poses.size()) {
        throw InternalError({.what = "a keyshape has no mesh"});
      }
      const TriangleMesh& mesh = poses[pose];
      if (mesh.positions.rows() != rest.positions.rows()) {
        throw InputError({.where = mesh.source,
                          .what = "the mesh has other vertices than " + rest.source,
                          .expected = std::to_string(rest.positions.rows()),
                          .got = std::to_string(mesh.positions.rows()),
                          .remedy = "Pose the mesh at rest; do not cut or weld it."});
      }
      const Points offsets = shares.asDiagonal() * (mesh.positions - rest.positions);
      targets.values.row(static_cast<Eigen::Index>(pose)) =
          Eigen::Map<const Eigen::RowVectorXd>(offsets.data(), offsets.size());
    }
  }
  return targets;
}

} // namespace phonomime
