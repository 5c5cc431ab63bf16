// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/style/bilinear_model.h"
#include "synth/style/content_solver.h"
#include "synth/style/frame_vectors.h"

#include <vector>

#include <Eigen/Core>

namespace phonomime {

// Gives motion of known style another one (T2.10, T2.11, mixtures by T2.15): the middle frames of
//   y_new = y + (B_wanted - B_shown) c,   c from y and B_shown.
// What a frame shows beside the model stays in it (the papers drop it), so that a style which is
// kept changes nothing at all.
class Restyler {
public:
  // Throws InputError where the vectors have another size than those of the training.
  Restyler(const AsymmetricModel& model, const FrameVectors& vectors, double ridge);

  // coefficients: #frames by #dimensions. shown, wanted: S by #frames, the weights of the model's
  // styles that each frame shows and is to show; a column sums to 1. A frame that shows several
  // styles has the weighted mean of the contents that each of them would give it. Throws InputError
  // for numbers that are not finite, InternalError for weights of another shape.
  FrameMatrixD restyle(const Eigen::Ref<const FrameMatrixD>& coefficients,
                       const Eigen::Ref<const Eigen::MatrixXd>& shown,
                       const Eigen::Ref<const Eigen::MatrixXd>& wanted) const;

  Eigen::Index style_count() const { return static_cast<Eigen::Index>(contents_.size()); }

private:
  struct ContentMap { // c = matrix * y + shift
    Eigen::MatrixXd matrix;
    Eigen::VectorXd shift;
  };
  FrameVectors vectors_;
  std::vector<ContentMap> contents_;   // S
  std::vector<Eigen::MatrixXd> shown_; // S of #dimensions by J: the bases' middle rows
};

// Weights (S by #frames) whose changes glide: each row is averaged under a raised cosine of this
// duration around each frame, its ends held. Sums over the styles stay as they are.
Eigen::MatrixXd glide(const Eigen::Ref<const Eigen::MatrixXd>& weights, double rate_hz,
                      double duration_s);

} // namespace phonomime
