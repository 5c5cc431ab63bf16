// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"
#include "db/types/text.h"
#include "synth/retarget/keyshapes/rig_consistency.h"
#include "synth/retarget/keyshapes/rig_motion.h"
#include "tools/app/retarget_source.h"
#include "tools/app/rig_weights.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

constexpr std::size_t kMostConflicts = 5; // that are worth a note each

RigInUse read_shape_rig(const RetargetSource& source) {
  const std::filesystem::path& path = source.options.rig.rig;
  if (path.empty()) {
    throw UsageError(
        {.where = "--method keyshapes",
         .what = "needs a rig",
         .remedy = "Name it with --rig; `phonomime retarget keyshapes select` begins one."});
  }
  RigInUse used = read_rig(path, source.table);
  if (used.rig.target != RigTarget::shapes) {
    throw InputError(
        {.where = path.string(),
         .what = "the rig's target is no face with shapes",
         .expected = "shapes",
         .got = std::string(kRigTargetNames[static_cast<std::size_t>(used.rig.target)]),
         .remedy = "`phonomime retarget keyshapes apply` moves such a target."});
  }
  return used;
}

} // namespace

RetargetedWeights retarget_by_keyshapes(const RetargetSource& source, const Progress& progress) {
  const RigInUse used = read_shape_rig(source);
  const RigTargets targets = shape_targets(used.rig);
  progress.update("decomposing", 0, 1);
  const FrameMatrixD keyshape_weights = decompose_by_rig(
      used, source.options.rig, source.options.weights, source.table, source.motion);
  const FrameMatrixD found = targets.motion(keyshape_weights);
  const std::vector<std::string>& names = source.face.names;
  RetargetedWeights result{
      .weights = FrameMatrixD::Zero(found.rows(), static_cast<Eigen::Index>(names.size())),
      .notes = {},
      .figures_json = {}};
  for (std::size_t i = 0; i < targets.names.size(); ++i) {
    const auto place = std::ranges::find(names, targets.names[i]);
    if (place == names.end()) {
      throw InputError({.where = source.options.rig.rig.string(),
                        .what = "the face has no shape " + quoted(targets.names[i]),
                        .remedy = did_you_mean(targets.names[i], names)});
    }
    result.weights.col(place - names.begin()) = found.col(static_cast<Eigen::Index>(i));
  }
  const std::vector<RigConflict> conflicts =
      find_conflicts(used.rig, source.table.layout, used.keyshapes, targets, kMostConflicts);
  for (const RigConflict& conflict : conflicts) {
    result.notes.push_back(conflict_words(conflict));
  }
  result.figures_json = nlohmann::json{
      {"keyshapes", keyshape_weights.cols()},
      {"used", (keyshape_weights.array() != 0.0).colwise().any().count()},
      {"conflicts",
       conflicts.size()}}.dump();
  return result;
}

} // namespace phonomime
