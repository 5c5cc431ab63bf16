// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"

#include <optional>
#include <string_view>
#include <vector>

namespace phonomime {

// What carries the head pose: the rigid groups, or the reference marker where they are fewer than
// three (then the head is only centred, never turned).
struct HeadAnchor {
  std::vector<int> groups;     // into Layout::groups
  bool gives_rotation = false; // at least three groups
};

// Throws InputError, with `where`, where a marker layout has neither three rigid groups nor a
// reference marker.
HeadAnchor head_anchor(const Layout& layout, std::string_view where = "layout");

// E1-E2 with the determinant kept at +1 (Kabsch): the rotation R and translation t that make
// |R * reference + t - points| least in squares. Both 3 by #points, same order, mm. Nothing where
// there are fewer than three points or the reference points lie on a line: R is then not
// determined.
std::optional<HeadPose> fit_pose(const Eigen::Matrix3Xd& reference, const Eigen::Matrix3Xd& points);

// A marker of a frame (#channels by 1, mm).
inline Eigen::Vector3d marker_of(const Eigen::Ref<const Eigen::VectorXd>& frame, int group) {
  return frame.segment<3>(3 * group);
}

// `pose` (#channels, mm; NaN = missing) moved so that the centroid of the anchor's groups is at the
// origin. All of them must be present.
Eigen::VectorXd centred_on_anchor(const Eigen::VectorXd& pose, const HeadAnchor& anchor);

// True where every group of the anchor is present in the frame.
bool anchor_is_whole(const Eigen::Ref<const Eigen::VectorXd>& frame, const HeadAnchor& anchor);

// Root mean square distance of points (3 by #points) from their centroid.
double point_spread(const Eigen::Matrix3Xd& points);

// Frames without head motion, and that motion: frame = size * rotation * local + translation_mm.
struct HeadFree {
  FrameMatrixD local;            // #frames by #channels, mm; NaN stays where it was
  std::vector<HeadPose> head;    // #frames, neighbouring quaternions on the same side
  std::vector<double> size;      // #frames, of the reference's; 1 where the scale is measured
  Eigen::Index interpolated = 0; // frames whose pose came from their neighbours
  bool found = false;            // false: no frame shows enough of the anchor; the rest is empty
};

// Takes the head motion off. `frames` is #frames by #channels in mm, NaN = missing;
// `reference_pose` is #channels, centred on the anchor, with every group of the anchor present.
// Each frame's pose is fitted to those groups of the anchor that it shows; where these do not
// determine it, it is interpolated from the frames around (slerp, held at the ends). Where the
// scale is nominal, the size of those groups (point_spread) is taken off too.
HeadFree remove_head(const FrameMatrixD& frames, const HeadAnchor& anchor,
                     const Eigen::VectorXd& reference_pose, Scale scale);

} // namespace phonomime
