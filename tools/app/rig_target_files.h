// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/export/glb.h"
#include "synth/retarget/keyshapes/joint_figure.h"
#include "synth/retarget/keyshapes/rig_motion.h"
#include "synth/retarget/keyshapes/svg_drawing.h"
#include "synth/retarget/triangle_mesh.h"

#include <filesystem>
#include <optional>
#include <string>

namespace phonomime {

// Whether the output's suffix is one of a rig's of this target: .csv; .svg of a drawing; .glb of a
// figure or a mesh. Throws UsageError.
void check_rig_output(const std::filesystem::path& output, RigTarget target);

// A rig's target at rest and in its keyshapes, and the files that weights of them become. An .obj
// is taken to be in centimetres, a .glb is in metres.
class RigTargetFiles {
public:
  // `folder`: that the rig's paths start from. Throws InputError and IoError.
  RigTargetFiles(const Rig& rig, const std::filesystem::path& folder);

  const RigTargets& targets() const { return targets_; }

  // The bytes of a file of that suffix; `weights`: #frames by #keyshapes. A .csv has weights of the
  // target's shapes, rotations of its joints, else weights of the keyshapes.
  std::string bytes(const std::filesystem::path& output, const FrameMatrixD& weights,
                    double rate_hz, const GlbNotes& notes) const;

private:
  void read_meshes(const std::filesystem::path& folder);
  void read_drawings(const std::filesystem::path& folder);
  std::string csv(const FrameMatrixD& weights, double rate_hz) const;
  std::string glb(const FrameMatrixD& weights, double rate_hz, const GlbNotes& notes) const;

  const Rig& rig_;
  RigTargets targets_;
  std::optional<JointFigure> figure_;
  std::optional<SvgDrawing> drawing_;
  TriangleMesh mesh_;
  double unit_mm_ = 1.0; // of the mesh
};

} // namespace phonomime
