// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <Eigen/Core>

namespace phonomime {

// What a frame's vector holds. A style model must not be centred (DESIGN section 7), and PCA
// coefficients are; so both have a last number that stays.
enum class StyleVectors {
  // Its channels' place, E11, in the orthonormal basis of the PCA and of what of the mean lies
  // outside it: [basis' mean + coefficients; length of (mean - basis basis' mean)]. Distances,
  // products and hence bilinear models are those of the channels, in a tenth of the numbers.
  channels,
  // [coefficients; length of the mean]: distances are the same, but the mean face counts as a
  // movement of its own.
  coefficients,
};

// Motion frames as the vectors of a style model. n frames in a row make a bundle (T2.14), the
// earliest on top.
class FrameVectors {
public:
  // `bundle`: n, odd and positive. Throws InputError.
  FrameVectors(const PcaModel& pca, int bundle, StyleVectors holds = StyleVectors::channels);

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
  Eigen::VectorXd origin_; // where coefficients of 0 are
  double constant_ = 0.0;  // the last number
  int bundle_;
};

} // namespace phonomime
