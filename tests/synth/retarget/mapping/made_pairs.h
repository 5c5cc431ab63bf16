// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <random>

#include <Eigen/QR>

namespace phonomime::test {

// Uniform between -size and size.
inline FrameMatrixD made_matrix(Eigen::Index rows, Eigen::Index columns, double size,
                                unsigned seed) {
  std::mt19937 random(seed);
  FrameMatrixD matrix(rows, columns);
  for (double& value : matrix.reshaped()) {
    value = size * (2.0 * static_cast<double>(random()) / 4294967295.0 - 1.0);
  }
  return matrix;
}

// A PCA of `channels` channels that keeps `dimensions`; its mean is not zero.
inline PcaModel made_pca(Eigen::Index channels, Eigen::Index dimensions, unsigned seed) {
  PcaModel pca;
  pca.mean = made_matrix(channels, 1, 30.0, seed);
  const Eigen::MatrixXd any = made_matrix(channels, channels, 1.0, seed + 1);
  pca.basis =
      (any.householderQr().householderQ() * Eigen::MatrixXd::Identity(channels, dimensions));
  pca.variance = Eigen::VectorXd::LinSpaced(dimensions, static_cast<double>(dimensions), 1.0);
  return pca;
}

} // namespace phonomime::test
