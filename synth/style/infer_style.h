// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/style/bilinear_model.h"

#include <vector>

#include <Eigen/Core>

namespace phonomime {

struct InferOptions {
  double ridge = 0.0; // of the contents, as ContentSolver takes it
  // T2.3.3: for so many iterations the first content coefficient is held at its training mean.
  int hold_first = 5;
  int most_iterations = 200;
  // Converged where an iteration takes off less than this share of the frames' root mean square.
  double tolerance = 1e-9;
};

// Frames of an expression that nobody named: one style vector for all of them (T2.3.4), a content
// each, scaled so that the first coefficient's mean is that of the training data.
struct InferredStyle {
  Eigen::VectorXd expression;      // I
  Eigen::MatrixXd contents;        // J by #frames
  std::vector<double> convergence; // root mean square of y - model after each iteration
  bool converged = false;
};

// T2.12 and T2.13 in turn, from the mean content on; y: K by #frames. Throws InputError for no
// frames, for another K than the model's and for numbers that are not finite.
InferredStyle infer_style(const SymmetricModel& model, const Eigen::Ref<const Eigen::MatrixXd>& y,
                          const InferOptions& options);

// What the model shows for a style vector (I) and contents (J by #frames): K by #frames. With an
// inferred style and trained contents, or the other way round, this is the translation of T2.3.3.
Eigen::MatrixXd show(const SymmetricModel& model,
                     const Eigen::Ref<const Eigen::VectorXd>& expression,
                     const Eigen::Ref<const Eigen::MatrixXd>& contents);

// The trained style (into styles) whose vector is nearest, ties to the smaller.
Eigen::Index nearest_style(const SymmetricModel& model,
                           const Eigen::Ref<const Eigen::VectorXd>& expression);

} // namespace phonomime
