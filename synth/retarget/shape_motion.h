// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "synth/retarget/placement.h"
#include "synth/retarget/shape_face.h"

#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// What moves a face with shapes of its own.
struct ShapeMotion {
  MotionClip weights; // a group for each shape of the face, one channel each, finite
  // #frames, or empty where the head rests: mm, in the axes that `placement` brings the face to.
  std::vector<HeadPose> head;
  Similarity placement; // of the face on its speaker
  FrameMatrix eyes;     // #frames by 6, rad: the last six of kLiveLinkColumns; or empty
};

// Weights by the names of a file, brought to a face's shapes.
struct WeightsForFace {
  MotionClip weights;
  std::vector<std::string> left_out; // names that the face does not have
};

// Each weight goes to the shapes that its name stands for (matching_shapes); a shape that several
// names stand for gets their mean. Names that the face does not have are left out where all their
// weights are under 1e-3, or `skip_missing` is asked for. Throws InputError, with `where`, for
// another that the face does not have (with the nearest that it has), and where none fits.
WeightsForFace weights_for_face(const MotionClip& clip, const std::vector<std::string>& shapes,
                                bool skip_missing, std::string_view where);

// A face's axes and unit are taken for glTF's (metres, y up, z forward) where nothing places it on
// a speaker; its head turns about the middle of the vertices that its shapes move.
Similarity free_placement(const ShapeFace& face);

// A pose of the speaker's head on the face: x goes to rotation * x + translation, in the face's
// unit and axes.
struct FacePose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};
FacePose pose_on_face(const HeadPose& head, const Similarity& placement);

// Angles of a head in rad: rotation = about y by yaw * about x by pitch * about z by roll, y up, z
// forward: yaw turns to its own left, pitch nods, roll leans to its own right.
struct HeadAngles {
  double yaw = 0.0;
  double pitch = 0.0;
  double roll = 0.0;
};
HeadAngles head_angles(const Eigen::Quaterniond& rotation);
Eigen::Quaterniond head_rotation(const HeadAngles& angles);

} // namespace phonomime
