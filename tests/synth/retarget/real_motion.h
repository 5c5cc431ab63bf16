// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/head.h"
#include "db/import/readers.h"
#include "db/types/file_io.h"
#include "db/types/layout.h"
#include "db/types/motion.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <Eigen/Eigenvalues>

namespace phonomime::test {

// Recorded motion without head movement, and a PCA of it.
struct RealMotion {
  Layout layout;
  FrameMatrixD channels;     // #frames by #channels, mm
  Eigen::VectorXd reference; // the frame whose lips are closest
  PcaModel pca;              // 25 dimensions
};

// Every `step`-th sentence of grid_s1 that has no gap.
inline RealMotion read_real_motion(const std::filesystem::path& data, int step) {
  RealMotion motion;
  motion.layout = parse_layout(read_file(data / "grid_s1/layout.json"), "layout.json");
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(data / "grid_s1/motion")) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  const HeadAnchor anchor = head_anchor(motion.layout);
  std::vector<FrameMatrixD> takes;
  Eigen::VectorXd first;
  Eigen::Index frames = 0;
  for (std::size_t i = 0; i < files.size(); i += static_cast<std::size_t>(step)) {
    const FrameMatrixD raw = read_motion(files[i]).frames.cast<double>();
    if (!raw.allFinite()) {
      continue;
    }
    if (first.size() == 0) {
      first = centred_on_anchor(raw.row(0).transpose(), anchor);
    }
    takes.push_back(remove_head(raw, anchor, first, Scale::nominal).local);
    frames += takes.back().rows();
  }
  motion.channels.resize(frames, motion.layout.channel_count());
  Eigen::Index at = 0;
  for (const FrameMatrixD& take : takes) {
    motion.channels.middleRows(at, take.rows()) = take;
    at += take.rows();
  }
  const int upper = 3 * *motion.layout.find_landmark("lip_upper_inner") + 1;
  const int lower = 3 * *motion.layout.find_landmark("lip_lower_inner") + 1;
  Eigen::Index closest = 0;
  (motion.channels.col(upper) - motion.channels.col(lower)).cwiseAbs().minCoeff(&closest);
  motion.reference = motion.channels.row(closest).transpose();
  motion.pca.mean = motion.channels.colwise().mean().transpose();
  const Eigen::MatrixXd centred = motion.channels.rowwise() - motion.pca.mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(centred.transpose() * centred /
                                                             static_cast<double>(frames));
  motion.pca.basis = eigen.eigenvectors().rightCols(25).rowwise().reverse();
  motion.pca.variance = eigen.eigenvalues().tail(25).reverse();
  return motion;
}

} // namespace phonomime::test
