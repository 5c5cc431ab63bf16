// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/time_warp.h"

namespace phonomime {

namespace {

template <typename Matrix>
void warp(const Eigen::Ref<const Matrix>& node, Eigen::Ref<FrameMatrixD> warped) {
  const Eigen::Index last = node.rows() - 1;
  const Eigen::Index frames = warped.rows();
  for (Eigen::Index i = 0; i < frames; ++i) {
    // u = numerator / denominator, kept whole so that no rounding moves it off a frame.
    const Eigen::Index numerator = frames == 1 ? last : i * last;
    const Eigen::Index denominator = frames == 1 ? 2 : frames - 1;
    const Eigen::Index before = numerator / denominator;
    const Eigen::Index rest = numerator % denominator;
    warped.row(i) = node.row(before).template cast<double>();
    if (rest != 0) {
      const double share = static_cast<double>(rest) / static_cast<double>(denominator);
      warped.row(i) += share * (node.row(before + 1).template cast<double>() - warped.row(i));
    }
  }
}

} // namespace

void time_warp(const Eigen::Ref<const FrameMatrix>& node, Eigen::Ref<FrameMatrixD> warped) {
  warp<FrameMatrix>(node, warped);
}

void time_warp(const Eigen::Ref<const FrameMatrixD>& node, Eigen::Ref<FrameMatrixD> warped) {
  warp<FrameMatrixD>(node, warped);
}

} // namespace phonomime
