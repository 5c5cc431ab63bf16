// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/singular_vectors.h"

#include "db/types/errors.h"

#include <Eigen/SVD>

namespace phonomime {

SingularVectors singular_vectors(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  if (svd.info() != Eigen::Success) {
    throw InternalError({.what = "a singular value decomposition did not converge"});
  }
  SingularVectors found{svd.matrixU(), svd.singularValues(), svd.matrixV()};
  for (Eigen::Index k = 0; k < found.values.size(); ++k) {
    Eigen::Index largest = 0;
    found.left.col(k).cwiseAbs().maxCoeff(&largest);
    if (found.left(largest, k) < 0.0) {
      found.left.col(k) = -found.left.col(k);
      found.right.col(k) = -found.right.col(k);
    }
  }
  return found;
}

} // namespace phonomime
