// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/rig_target_files.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/text.h"
#include "synth/export/shape_files.h"
#include "synth/retarget/keyshapes/mesh_targets.h"
#include "synth/retarget/mesh_reader.h"

#include <utility>
#include <vector>

namespace phonomime {

namespace {

std::string suffix_of(const std::filesystem::path& path) {
  return to_lower(path.extension().string());
}

// `time,<name>,...`
std::string table_of(const std::vector<std::string>& names, const FrameMatrixD& weights,
                     double rate_hz) {
  ShapeMotion motion;
  motion.weights = {.rate_hz = rate_hz,
                    .groups = names,
                    .channels_per_group = 1,
                    .frames = weights.cast<float>()};
  return shape_weight_csv(motion);
}

} // namespace

void check_rig_output(const std::filesystem::path& output, RigTarget target) {
  const std::string suffix = suffix_of(output);
  const bool fits =
      suffix == ".csv" || (suffix == ".svg" && target == RigTarget::drawing) ||
      (suffix == ".glb" && (target == RigTarget::joints || target == RigTarget::mesh));
  if (!fits) {
    throw UsageError(
        {.where = output.string(),
         .what = "the suffix names no kind of output of this rig",
         .expected = target == RigTarget::shapes    ? ".csv"
                     : target == RigTarget::drawing ? ".csv or .svg"
                                                    : ".csv or .glb",
         .got = quoted(suffix),
         .remedy = target == RigTarget::shapes
                       ? "`phonomime retarget apply --method keyshapes` moves a face itself."
                       : ""});
  }
}

RigTargetFiles::RigTargetFiles(const Rig& rig, const std::filesystem::path& folder) : rig_(rig) {
  switch (rig.target) {
  case RigTarget::shapes:
    targets_ = shape_targets(rig);
    break;
  case RigTarget::joints:
    figure_.emplace(read_file(folder / rig.file), (folder / rig.file).string());
    targets_ = figure_->targets(rig);
    break;
  case RigTarget::mesh:
    read_meshes(folder);
    break;
  case RigTarget::drawing:
    read_drawings(folder);
    break;
  }
}

void RigTargetFiles::read_meshes(const std::filesystem::path& folder) {
  mesh_ = read_mesh(folder / rig_.file);
  std::vector<TriangleMesh> poses;
  for (const RigSet& set : rig_.sets) {
    for (const RigKeyshape& keyshape : set.keyshapes) {
      poses.push_back(read_mesh(folder / keyshape.file));
    }
  }
  targets_ = mesh_targets(rig_, mesh_, poses);
  unit_mm_ = suffix_of(rig_.file) == ".glb" ? 1000.0 : 10.0;
}

void RigTargetFiles::read_drawings(const std::filesystem::path& folder) {
  drawing_.emplace(read_file(folder / rig_.file), (folder / rig_.file).string());
  targets_.names = drawing_->number_names();
  targets_.values.resize(static_cast<Eigen::Index>(keyshape_names(rig_).size()),
                         drawing_->numbers().size());
  Eigen::Index row = 0;
  for (const RigSet& set : rig_.sets) {
    for (const RigKeyshape& keyshape : set.keyshapes) {
      const std::filesystem::path path = folder / keyshape.file;
      const SvgDrawing pose(read_file(path), path.string());
      drawing_->check_equal_structure(pose);
      targets_.values.row(row++) = pose.numbers() - drawing_->numbers();
    }
  }
}

std::string RigTargetFiles::bytes(const std::filesystem::path& output, const FrameMatrixD& weights,
                                  double rate_hz, const GlbNotes& notes) const {
  const std::string suffix = suffix_of(output);
  if (suffix == ".csv") {
    return csv(weights, rate_hz);
  }
  if (suffix == ".svg" && drawing_) {
    return drawing_->animated(targets_.motion(weights).rowwise() + drawing_->numbers(), rate_hz);
  }
  return glb(weights, rate_hz, notes);
}

std::string RigTargetFiles::csv(const FrameMatrixD& weights, double rate_hz) const {
  if (rig_.target == RigTarget::shapes) {
    return table_of(targets_.names, targets_.motion(weights), rate_hz);
  }
  if (figure_) {
    return figure_->rotations_csv(targets_, targets_.motion(weights), rate_hz);
  }
  return table_of(keyshape_names(rig_), weights, rate_hz);
}

std::string RigTargetFiles::glb(const FrameMatrixD& weights, double rate_hz,
                                const GlbNotes& notes) const {
  if (figure_) {
    return figure_->animated(targets_, targets_.motion(weights), rate_hz);
  }
  MorphTargets morphs{unit_mm_ * mesh_.positions, {}};
  for (Eigen::Index i = 0; i < targets_.values.rows(); ++i) {
    const Eigen::RowVectorXd flat = unit_mm_ * targets_.values.row(i);
    morphs.morphs.push_back(Eigen::Map<const Points>(flat.data(), mesh_.positions.rows(), 3));
  }
  CoefficientMotion motion{.rate_hz = rate_hz};
  motion.coefficients = weights;
  return marker_face_glb(mesh_, morphs, motion, notes);
}

} // namespace phonomime
