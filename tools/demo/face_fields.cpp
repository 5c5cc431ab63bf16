// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/face_fields.h"

#include <algorithm>
#include <cmath>

#include "tools/demo/marker_layout.h"
#include "tools/demo/random.h"

namespace phonomime::demo {

namespace {

using Eigen::RowVector3d;

// The condyles glide forwards as the jaw opens, so that the effective axis lies below them.
const RowVector3d kJawHinge(0.0, -25.0, -60.0);

// Way of a point of the jaw, turned about the hinge by an angle in radians.
RowVector3d turn_jaw(const RowVector3d& point, double angle) {
  const double y = point.y() - kJawHinge.y();
  const double z = point.z() - kJawHinge.z();
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {0.0, c * y - s * z - y, s * y + c * z - z};
}

double gaussian(double distance_sq, double sigma) {
  return std::exp(-0.5 * distance_sq / (sigma * sigma));
}

// How the skin of the lower face shares in the jaw's turn, by height: none at the nose, all at the
// chin.
double jaw_share(double y) {
  return ramp(-y, 25.0, 88.0);
}

} // namespace

// What the middle and the corners of the mouth do, in mm.
struct FaceFields::Mouth {
  double upper_y = 0.0;  // middle of the upper lip
  double lower_y = 0.0;  // middle of the lower lip
  double corner_x = 0.0; // outwards
  double corner_y = 0.0;
  double corner_z = 0.0;
  double forward = 0.0;
  double tuck = 0.0;
  double press = 0.0;
  double jaw_angle = 0.0;
  double lip_jaw_z = 0.0; // the jaw's share in the lower lip's depth
};

FaceFields::FaceFields(MarkerPose rest) : rest_(std::move(rest)) {}

MarkerPose FaceFields::pose(const FaceState& state) const {
  const Articulators& v = state.speech.value;
  const Expression& e = state.expression;
  const double i = state.intensity;
  const double loose = (1.0 - state.speech.lip_closure) * (1.0 - state.speech.lip_tuck);
  const double opening = std::max(0.0, v[aperture]) + i * e.parting * loose;

  Mouth mouth;
  const RowVector3d chin = rest_.row(marker_index(152));
  const double lever = (chin - kJawHinge).tail<2>().norm();
  mouth.jaw_angle = std::max(0.0, v[jaw]) / lever;
  const double drop = std::max(0.0, v[jaw]);
  mouth.upper_y = 0.2 * opening + v[upper_raise] + i * e.upper_lip_raise - 0.1 * drop;
  mouth.lower_y = mouth.upper_y - opening;
  mouth.corner_x = v[width] + i * e.corner_out;
  mouth.corner_y = i * e.corner_up - 0.3 * drop;
  mouth.forward = v[protrusion];
  mouth.corner_z = 0.45 * v[protrusion] - 0.3 * std::max(0.0, v[width]) - i * e.corner_back;
  mouth.press = i * e.lip_press + 0.8 * state.speech.lip_closure;
  const double apart = 1.0 - state.speech.lip_closure; // closed lips meet in depth too
  mouth.tuck = apart * v[tuck];
  mouth.lip_jaw_z = apart * 0.5 * turn_jaw(rest_.row(marker_index(14)), mouth.jaw_angle).z();

  MarkerPose posed = rest_;
  move_lips(state, mouth, posed);
  move_skin(state, mouth, posed);
  move_eyes(state, posed);
  return posed;
}

void FaceFields::move_lips(const FaceState& state, const Mouth& mouth, MarkerPose& pose) const {
  const double chin_push = 0.5 * state.intensity * state.expression.chin_raise;
  const double half_width = rest_(marker_index(kInnerCornerLeft), 0);
  for (const LipColumn& column : kLipColumns) {
    const double s = rest_(marker_index(column.upper_inner), 0) / half_width;
    const double middle = 1.0 - std::pow(std::abs(s), 2.2); // 1 in the middle, 0 at the corners
    const double side = 1.0 - middle;
    const double line_y = side * mouth.corner_y;
    const double x = s * mouth.corner_x;
    const double z = side * mouth.corner_z + middle * mouth.forward;
    const double pout = 0.12 * middle * std::max(0.0, mouth.forward);
    const double shut = 0.6 * middle * mouth.press;
    const double upper_y = line_y + middle * mouth.upper_y;
    const double lower_y = line_y + middle * mouth.lower_y;
    const double lower_z = z + middle * (mouth.lip_jaw_z - mouth.tuck);

    pose.row(marker_index(column.upper_inner)) += RowVector3d(x, upper_y, z);
    pose.row(marker_index(column.upper_outer)) +=
        RowVector3d(x, 0.85 * upper_y + pout - shut, 0.85 * z - 0.3 * shut);
    pose.row(marker_index(column.lower_inner)) += RowVector3d(x, lower_y, lower_z);
    pose.row(marker_index(column.lower_outer)) +=
        RowVector3d(x, lower_y - pout + shut + middle * (0.5 * mouth.tuck + chin_push),
                    0.85 * z + middle * (mouth.lip_jaw_z - 0.5 * mouth.tuck) - 0.3 * shut);
  }
  for (const int corner : {kInnerCornerRight, kOuterCornerRight})
    pose.row(marker_index(corner)) += RowVector3d(-mouth.corner_x, mouth.corner_y, mouth.corner_z);
  for (const int corner : {kInnerCornerLeft, kOuterCornerLeft})
    pose.row(marker_index(corner)) += RowVector3d(mouth.corner_x, mouth.corner_y, mouth.corner_z);
}

void FaceFields::move_skin(const FaceState& state, const Mouth& mouth, MarkerPose& pose) const {
  constexpr double kCornerReach_mm = 15.0;
  constexpr double kCheekReach_mm = 15.0;
  const Expression& e = state.expression;
  const double i = state.intensity;
  const RowVector3d corner_left = rest_.row(marker_index(kOuterCornerLeft));
  for (const int vertex : {152, 148, 377, 176, 400, 150, 379, 136, 365, 172, 397, 50, 280, 205,
                           425, 187, 411, 207, 427, 216, 436, 1,   4,   5,   2,   98, 327}) {
    const int marker = marker_index(vertex);
    const RowVector3d at = rest_.row(marker);
    const double side = at.x() > 0.0 ? 1.0 : at.x() < 0.0 ? -1.0 : 0.0;
    const RowVector3d mirrored(std::abs(at.x()), at.y(), at.z());
    RowVector3d way = turn_jaw(at, jaw_share(at.y()) * mouth.jaw_angle);

    const double near_corner =
        0.9 * gaussian((mirrored - corner_left).squaredNorm(), kCornerReach_mm);
    way += near_corner * RowVector3d(side * mouth.corner_x, mouth.corner_y, mouth.corner_z);

    const double on_cheek =
        gaussian((mirrored - RowVector3d(45.0, -14.0, 36.0)).squaredNorm(), kCheekReach_mm);
    way += on_cheek * i * e.cheek_raise * RowVector3d(0.1 * side, 1.0, 0.35);

    const double on_chin = gaussian((at - rest_.row(marker_index(152))).squaredNorm(), 18.0);
    way += on_chin * i * e.chin_raise * RowVector3d(0.0, 1.0, 0.2);

    if (vertex == 98 || vertex == 327)
      way += i * e.nostril_flare * RowVector3d(side, 0.5, 0.0);
    if (vertex == 2)
      way += RowVector3d(0.0, 0.1 * mouth.upper_y, 0.12 * mouth.forward);
    pose.row(marker) += way;
  }
}

void FaceFields::move_eyes(const FaceState& state, MarkerPose& pose) const {
  const Expression& e = state.expression;
  const double i = state.intensity;
  for (const int vertex : {70, 63, 105, 66, 107, 336, 296, 334, 293, 300}) {
    const int marker = marker_index(vertex);
    const double x = rest_(marker, 0);
    const double outer = ramp(std::abs(x), 12.0, 54.0);
    pose.row(marker) +=
        i * RowVector3d((x > 0.0 ? -1.0 : 1.0) * (1.0 - outer) * e.brow_furrow,
                        (1.0 - outer) * e.brow_inner_raise + outer * e.brow_outer_raise,
                        0.3 * (1.0 - outer) * std::max(0.0, e.brow_furrow));
  }
  const std::pair<int, int> lids[] = {{159, 145}, {386, 374}};
  for (const auto& [upper_vertex, lower_vertex] : lids) {
    const int upper = marker_index(upper_vertex);
    const int lower = marker_index(lower_vertex);
    const double lower_raise = i * e.lower_lid_raise + 0.4 * state.blink;
    const double open = rest_(upper, 1) - rest_(lower, 1) - lower_raise;
    const double drop = i * e.upper_lid_drop;
    pose(lower, 1) += lower_raise;
    pose(upper, 1) -= drop + state.blink * (open - drop);
  }
}

} // namespace phonomime::demo
