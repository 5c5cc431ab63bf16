// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/marker_face.h"

#include "db/types/errors.h"

#include <algorithm>
#include <cmath>

namespace phonomime {
namespace {

// #channels (x, y, z of each marker in turn) as #markers by 3.
Points as_points(const Eigen::VectorXd& channels) {
  return Eigen::Map<const Points>(channels.data(), channels.size() / 3, 3);
}

// Points of some groups' vertices: #groups by 3.
Points rows_of(const Points& positions, const std::vector<int>& vertices,
               const std::vector<int>& groups) {
  Points rows(groups.size(), 3);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) =
        positions.row(vertices[static_cast<std::size_t>(groups[i])]);
  }
  return rows;
}

} // namespace

Points MorphTargets::at(const Eigen::VectorXd& coefficients) const {
  Points shape = base;
  for (std::size_t d = 0; d < morphs.size(); ++d) {
    shape += coefficients(static_cast<Eigen::Index>(d)) * morphs[d];
  }
  return shape;
}

MarkerFace::MarkerFace(FaceSource source, const Layout& layout,
                       const Eigen::VectorXd& reference_pose, const SpreadOptions& options)
    : layout_(layout), reference_pose_(reference_pose), mesh_(std::move(source.mesh)),
      marker_vertices_(std::move(source.markers.vertices)) {
  if (layout.kind != LayoutKind::markers || reference_pose.size() != layout.channel_count() ||
      marker_vertices_.size() != layout.groups.size()) {
    throw InternalError(
        {.what = "a face, its layout and its reference pose do not belong together"});
  }
  report_.automatic_markers = source.markers.automatic;
  report_.missing_markers = std::move(source.markers.missing);
  report_.unknown_markers = std::move(source.markers.unknown);

  const Points reference = as_points(reference_pose_);
  report_.placement = place_on_markers(mesh_, marker_vertices_, reference);
  mesh_.positions = report_.placement.apply(mesh_.positions);
  OpeningFill fill = find_opening_fill(mesh_, mesh_.positions, layout_, marker_vertices_);
  report_.cut = std::move(fill.openings);
  mesh_ = without_triangles(std::move(mesh_), fill.filling);
  const EdgeGraph graph(mesh_.positions,
                        mesh_.triangles.topRows(mesh_.parts.front().triangle_count));
  weights_ = spread_weights(graph, marker_vertices_, options);
  for (const auto& [landmark, unused] : layout_.landmarks) {
    const int vertex = marker_vertices_[static_cast<std::size_t>(*layout_.find_landmark(landmark))];
    if (vertex >= 0) {
      landmarks_[landmark] = vertex;
    }
  }
  sort_inner();
  bring_to_reference(reference);
}

std::vector<int> MarkerFace::groups_on_face(Region region) const {
  std::vector<int> groups = layout_.groups_in(region);
  std::erase_if(groups, [&](int g) { return marker_vertices_[static_cast<std::size_t>(g)] < 0; });
  return groups;
}

void MarkerFace::sort_inner() {
  if (mesh_.parts.size() < 2) {
    return;
  }
  // Upright as in the file: a speaker's head may be tilted in the reference pose.
  const Points upright = mesh_.positions * report_.placement.rotation;
  FacePlaces places;
  jaw_markers_ = groups_on_face(Region::jaw);
  jaw_ = JawMotion(rows_of(mesh_.positions, marker_vertices_, jaw_markers_));
  const auto vertex = [&](std::string_view landmark) {
    const auto found = landmarks_.find(landmark);
    return found == landmarks_.end() ? -1 : found->second;
  };
  const int upper = vertex("lip_upper_inner");
  const int lower = vertex("lip_lower_inner");
  const int right = vertex("mouth_corner_right");
  const int left = vertex("mouth_corner_left");
  if (std::min({upper, lower, right, left}) >= 0 && !jaw_.empty()) {
    places.mouth =
        MouthPlace{.centre = 0.5 * (upright.row(upper) + upright.row(lower)),
                   .half_width = 0.5 * (upright.row(right) - upright.row(left)).norm(),
                   .chin_y = rows_of(upright, marker_vertices_, jaw_markers_).col(1).minCoeff()};
  }
  const auto [right_lids, left_lids] = eyelids_by_side();
  for (const auto& lids : {right_lids, left_lids}) {
    const Points at = rows_of(upright, marker_vertices_, lids);
    EyePlace eye;
    if (!lids.empty()) {
      eye.centre = at.colwise().mean();
      eye.radius = (at.rowwise() - eye.centre).rowwise().norm().maxCoeff();
    }
    places.eyes.push_back(eye);
  }
  report_.inner = sort_inner_parts(mesh_, upright, places);
  inner_ = std::move(report_.inner.vertices);
}

std::array<std::vector<int>, 2> MarkerFace::eyelids_by_side() const {
  std::array<std::vector<int>, 2> sides;
  const std::vector<int> lids = groups_on_face(Region::eyelids);
  if (lids.empty()) {
    return sides;
  }
  const double middle = rows_of(mesh_.positions, marker_vertices_, lids).col(0).mean();
  for (const int g : lids) {
    const bool left = mesh_.positions(marker_vertices_[static_cast<std::size_t>(g)], 0) > middle;
    sides[left ? 1 : 0].push_back(g);
  }
  return sides;
}

void MarkerFace::bring_to_reference(const Points& reference) {
  Points offsets = Points::Zero(reference.rows(), 3);
  const std::vector<int> lips = groups_on_face(Region::lips);
  for (const auto& groups : {lips, groups_on_face(Region::eyelids)}) {
    for (const int g : groups) {
      offsets.row(g) =
          reference.row(g) - mesh_.positions.row(marker_vertices_[static_cast<std::size_t>(g)]);
    }
  }
  Points moved = weights_ * offsets;
  report_.largest_offset_mm = moved.rowwise().norm().maxCoeff();
  // What lies behind lips and lids goes with them as a whole: teeth with the mean of the lips.
  const auto mean_offset = [&](const std::vector<int>& groups) -> Eigen::RowVector3d {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (const int g : groups) {
      sum += offsets.row(g);
    }
    return sum / std::max(static_cast<double>(groups.size()), 1.0);
  };
  const auto [right_lids, left_lids] = eyelids_by_side();
  const std::array<Eigen::RowVector3d, 3> shifts = {mean_offset(lips), mean_offset(right_lids),
                                                    mean_offset(left_lids)};
  for (std::size_t i = 0; i < inner_.size(); ++i) {
    const Eigen::Index v = mesh_.skin_vertex_count() + static_cast<Eigen::Index>(i);
    if (inner_[i].anchor >= 0) {
      moved.row(v) = moved.row(inner_[i].anchor);
    } else if (inner_[i].place != kNowhere) {
      moved.row(v) = shifts[static_cast<std::size_t>(inner_[i].place)];
    }
  }
  mesh_.positions += moved;
}

Points MarkerFace::displacements(const Eigen::VectorXd& channels) const {
  const Points markers = as_points(channels);
  Points moved = weights_ * markers; // E15
  if (inner_.empty()) {
    return moved;
  }
  SmallMotion jaw;
  if (!jaw_.empty()) {
    jaw = jaw_.fit(markers(jaw_markers_, Eigen::all));
  }
  const Eigen::Index first = mesh_.skin_vertex_count();
  for (std::size_t i = 0; i < inner_.size(); ++i) {
    const Eigen::Index v = first + static_cast<Eigen::Index>(i);
    if (inner_[i].anchor >= 0) {
      moved.row(v) = moved.row(inner_[i].anchor);
    } else if (inner_[i].jaw > 0.0) {
      moved.row(v) = inner_[i].jaw * jaw_.displacement(jaw, mesh_.positions.row(v));
    }
  }
  return moved;
}

Points MarkerFace::deform(const Eigen::VectorXd& channels) const {
  return mesh_.positions + displacements(channels - reference_pose_);
}

MorphTargets MarkerFace::morphs(const PcaModel& pca) const {
  MorphTargets targets;
  targets.base = deform(pca.mean);
  for (Eigen::Index d = 0; d < pca.dimension_count(); ++d) {
    targets.morphs.push_back(displacements(pca.basis.col(d)));
  }
  return targets;
}

std::optional<double> MarkerFace::aperture_share(const PcaModel& pca) const {
  const auto upper = layout_.find_landmark("lip_upper_inner");
  const auto lower = layout_.find_landmark("lip_lower_inner");
  const auto upper_vertex = landmarks_.find("lip_upper_inner");
  const auto lower_vertex = landmarks_.find("lip_lower_inner");
  if (!upper || !lower || upper_vertex == landmarks_.end() || lower_vertex == landmarks_.end()) {
    return std::nullopt;
  }
  // With deviations a (markers) and b (mesh), both linear: E[ab] / E[aa].
  double ab = 0.0;
  double aa = 0.0;
  const auto add = [&](const Eigen::VectorXd& deviation, double weight) {
    const Points mesh = displacements(deviation);
    const double a = deviation(3 * *upper + 1) - deviation(3 * *lower + 1);
    const double b = mesh(upper_vertex->second, 1) - mesh(lower_vertex->second, 1);
    ab += weight * a * b;
    aa += weight * a * a;
  };
  add(pca.mean - reference_pose_, 1.0);
  for (Eigen::Index d = 0; d < pca.dimension_count(); ++d) {
    add(pca.basis.col(d), pca.variance(d));
  }
  return aa > 0.0 ? std::optional(ab / aa) : std::nullopt;
}

} // namespace phonomime
