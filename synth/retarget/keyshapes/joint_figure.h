// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "synth/retarget/keyshapes/rig_motion.h"

#include <memory>
#include <string>
#include <string_view>

namespace phonomime {

// A figure of glTF nodes that turn (T section 3.2: joint angles instead of vertices, which would
// shrink limbs). A keyshape's rotation q of a node that rests at q0 is the vector of
// log(q0^-1 q): axis times angle. These add up by weights, q0 exp(sum of w v): no keyshape leaves
// the node at rest, a single one turns it by its share of the angle about its axis.
class JointFigure {
public:
  // Binary glTF 2.0. `where` names it. Throws InputError.
  JointFigure(const std::string& glb, std::string where);
  JointFigure(JointFigure&&) noexcept;
  ~JointFigure();

  // Names of the nodes, in the file's order.
  std::vector<std::string> nodes() const;

  // What a rig's keyshapes do: three values for each node that any of them turns, named NODE.x, .y,
  // .z, in radians. Throws InputError for a node that the file has not (with the nearest names),
  // has twice, or places by a matrix.
  RigTargets targets(const Rig& rig) const;

  // The file with an animation of the nodes. `motion`: #frames by #values of `targets`.
  std::string animated(const RigTargets& targets, const FrameMatrixD& motion, double rate_hz) const;

  // Rotations of a frame: `time,<node>_qx,<node>_qy,<node>_qz,<node>_qw,...`.
  std::string rotations_csv(const RigTargets& targets, const FrameMatrixD& motion,
                            double rate_hz) const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace phonomime
