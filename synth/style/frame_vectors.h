// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <Eigen/Core>

namespace phonomime {

// Motion frames as the vectors of a style model. A style model must not be centred (DESIGN section
// 7), but PCA coefficients are: a frame's vector is its channels' place, E11, in the orthonormal
// basis of the PCA and of what of the mean lies outside it:
//   [basis' mean + coefficients; length of (mean - basis basis' mean)]
// Distances, products and hence bilinear models are those of the channels themselves, in a tenth of
// the numbers. n frames in a row make a bundle (T2.14), the earliest on top.
class FrameVectors {
public:
  // `bundle`: n, odd and positive. Throws InputError.
  FrameVectors(const PcaModel& pca, int bundle);

  int bundle() const { return bundle_; }
  Eigen::Index dimension_count() const { return origin_.size(); }
  Eigen::Index frame_size() const { return origin_.size() + 1; }      // D
  Eigen::Index vector_size() const { return bundle_ * frame_size(); } // K
  Eigen::Index middle_row() const { return bundle_ / 2 * frame_size(); }

  // The vector of one frame of coefficients (#dimensions).
  void write_frame(const Eigen::Ref<const Eigen::VectorXd>& coefficients,
                   Eigen::Ref<Eigen::VectorXd> vector) const;

  // Bundles around each frame, the first and the last frame repeated at the ends: K by #frames.
  Eigen::MatrixXd bundles(const Eigen::Ref<const FrameMatrixD>& coefficients) const;

  // Middle frames (D by #frames) as coefficients (#frames by #dimensions).
  FrameMatrixD coefficients(const Eigen::Ref<const Eigen::MatrixXd>& middles) const;

private:
  Eigen::VectorXd origin_; // basis' mean
  double outside_ = 0.0;
  int bundle_;
};

} // namespace phonomime
