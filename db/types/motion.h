// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace phonomime {

// #frames by #channels (or #dimensions), one frame after the other in memory.
using FrameMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using FrameMatrixD = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Pose of the head: a frame's marker = rotation * (head-free marker) + translation_mm.
struct HeadPose {
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

// A recording as a motion reader gives it: the file's own groups, order, unit and axes.
// Frame k is at start_s + k / rate_hz.
struct MotionClip {
  double rate_hz = 0.0;
  double start_s = 0.0;            // time of frame 0 on the file's own clock, 0 where it has none
  std::vector<std::string> groups; // marker or weight names, in the order of the channels
  int channels_per_group = 3;      // 3 markers, 1 weights
  double unit_mm = 0.0;            // size of the file's unit where the file says it, else 0
  FrameMatrix frames;              // #frames by #groups * channels_per_group; NaN = missing

  Eigen::Index frame_count() const { return frames.rows(); }
  double duration_s() const { return static_cast<double>(frames.rows()) / rate_hz; }
};

// E11: channels = mean + basis * coefficients. The basis' columns are orthonormal.
struct PcaModel {
  Eigen::VectorXd mean;     // #channels
  Eigen::MatrixXd basis;    // #channels by #dimensions, sign fixed: largest entry positive
  Eigen::VectorXd variance; // #dimensions, of the kept frames, largest first
  double total_variance = 0.0;

  Eigen::Index channel_count() const { return mean.size(); }
  Eigen::Index dimension_count() const { return basis.cols(); }

  // E11 for one frame of coefficients (#dimensions): #channels.
  Eigen::VectorXd reconstruct(const Eigen::VectorXd& coefficients) const {
    return mean + basis * coefficients;
  }
  Eigen::VectorXd project(const Eigen::VectorXd& channels) const {
    return basis.transpose() * (channels - mean);
  }
};

// Synthesised motion in PCA coefficients: E11 gives its channels. Frame k is at k / rate_hz.
struct CoefficientMotion {
  double rate_hz = 0.0;
  FrameMatrixD coefficients;  // #frames by #dimensions
  std::vector<HeadPose> head; // #frames, or empty where the head rests
};

} // namespace phonomime
