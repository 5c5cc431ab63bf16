// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/style/style_stack.h"

#include <string>
#include <vector>

#include <Eigen/Core>

namespace phonomime {

// The two-factor models of T2.2.2: what is seen, y (K numbers), made of a style and a content c
// (J numbers). T and S leave the scale of contents open; here they have mean squares of 1 over the
// training data (V' of T2.9 times the root of T, the bases divided by it), so that a ridge means
// the same whatever the length of the recordings.

// T2.5, T2.8: y = B_s c.
struct AsymmetricModel {
  std::vector<std::string> styles; // S
  Eigen::Index vector_size = 0;    // K
  Eigen::MatrixXd bases;           // S K by J: B_s one below the other
  Eigen::VectorXd mean_content;    // J: over the training data
  Eigen::VectorXd spectrum;        // singular values of Y / sqrt(T), all of them, largest first
  double residual = 0.0;           // root mean square of Y - B C, a number of y

  Eigen::Index style_count() const { return static_cast<Eigen::Index>(styles.size()); }
  Eigen::Index content_size() const { return bases.cols(); }
  auto basis(Eigen::Index style) const {
    return bases.middleRows(style * vector_size, vector_size);
  }
};

// T2.9, S7-S8: the first J singular vectors. Throws InputError where J is less than 1 or more than
// the data have dimensions (the smaller of S K and T).
AsymmetricModel fit_asymmetric(const StackSummary& data, Eigen::Index content_size);

// T2.4, T2.7, S9: y = sum over i of e_i W^i c, where W^i (K by J) has row k = row i of the W_k of
// the papers: the bases of an asymmetric model, for each dimension of the style.
struct SymmetricModel {
  std::vector<std::string> styles; // S
  Eigen::Index vector_size = 0;    // K
  Eigen::MatrixXd bases;           // I K by J: W^i one below the other
  Eigen::MatrixXd expressions;     // I by S, orthonormal rows: the style vectors
  Eigen::VectorXd mean_content;    // J
  // Root mean square of Y - model after each iteration, a number of y; it never rises.
  std::vector<double> convergence;
  bool converged = false;

  Eigen::Index style_count() const { return static_cast<Eigen::Index>(styles.size()); }
  Eigen::Index style_size() const { return expressions.rows(); }
  Eigen::Index content_size() const { return bases.cols(); }
  // The basis that a style vector (I) selects: K by J.
  Eigen::MatrixXd basis(const Eigen::Ref<const Eigen::VectorXd>& expression) const;
};

struct SymmetricOptions {
  Eigen::Index style_size = 0;   // I, 1 to S
  Eigen::Index content_size = 0; // J
  int most_iterations = 500;
  // Converged where an iteration takes off less than this share of the data's root mean square.
  double tolerance = 1e-10;
};

// S9-S11: contents by the SVD of Y, then styles by that of [Y C']^VT and contents by that of
// [Y^VT E']^VT in turn, until the residual stays. With I = S one pass is all. Throws InputError for
// sizes that the data do not have.
SymmetricModel fit_symmetric(const StackSummary& data, const SymmetricOptions& options);

// The vector transpose (T2.6, S10): blocks of `block` rows change places with columns. m blocks by
// n becomes n blocks by m.
Eigen::MatrixXd vector_transpose(const Eigen::Ref<const Eigen::MatrixXd>& matrix,
                                 Eigen::Index block);

} // namespace phonomime
