// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace phonomime {

// matrix = left * diag(values) * right', r = the smaller of its sizes.
struct SingularVectors {
  Eigen::MatrixXd left;   // #rows by r
  Eigen::VectorXd values; // r, largest first
  Eigen::MatrixXd right;  // #columns by r
};

// The thin singular value decomposition of a finite matrix that is not empty. The largest entry of
// each left vector is positive. Throws InternalError where it does not converge.
SingularVectors singular_vectors(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

} // namespace phonomime
