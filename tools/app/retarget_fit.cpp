// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/retarget_source.h"

#include "db/types/errors.h"
#include "synth/retarget/placement.h"
#include "synth/retarget/weight_solver.h"

#include <cmath>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr double kRidge = 1e-3;
constexpr double kSparsity = 2e-3;
constexpr double kSmoothness = 0.3;

} // namespace

RetargetedWeights retarget_by_fit(const RetargetSource& source, const Progress&) {
  if (source.markers.vertices.empty()) {
    throw InputError({.where = source.options.database.string(),
                      .what = "shapes are fitted to markers, but the database is of weights",
                      .remedy = "Give the weights themselves, without --db."});
  }
  std::vector<int> placed;
  for (std::size_t g = 0; g < source.markers.vertices.size(); ++g) {
    if (source.markers.vertices[g] >= 0) {
      placed.push_back(static_cast<int>(g));
    }
  }
  const auto rows = 3 * static_cast<Eigen::Index>(placed.size());
  const auto shape_count = static_cast<Eigen::Index>(source.face.offsets.size());
  const Eigen::Matrix3d turn = source.placement.scale * source.placement.rotation;
  Eigen::MatrixXd shapes(rows, shape_count);
  FrameMatrixD offsets(source.motion.frame_count(), rows);
  for (std::size_t k = 0; k < placed.size(); ++k) {
    const auto group = static_cast<std::size_t>(placed[k]);
    const auto row = 3 * static_cast<Eigen::Index>(k);
    const auto channel = 3 * static_cast<Eigen::Index>(group);
    for (Eigen::Index s = 0; s < shape_count; ++s) {
      const Points& shape = source.face.offsets[static_cast<std::size_t>(s)];
      shapes.col(s).segment<3>(row) = turn * shape.row(source.markers.vertices[group]).transpose();
    }
    offsets.middleCols<3>(row) = source.motion.channels.middleCols<3>(channel).rowwise() -
                                 source.table.reference_pose.segment<3>(channel).transpose();
  }
  const WeightSolver solver(shapes, {},
                            {.ridge = kRidge, .sparsity = kSparsity, .smoothness = kSmoothness});
  RetargetedWeights result{.weights = solver.solve(offsets), .notes = {}, .figures_json = {}};
  const FrameMatrixD left = offsets - result.weights * shapes.transpose();
  const double rms = std::sqrt(3.0 * left.array().square().mean());
  result.notes.push_back(fmt::format("markers are left {:.2f} mm off (root mean square)", rms));
  return result;
}

} // namespace phonomime
