// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/map_places.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace phonomime {

namespace {

// Columns of `values` less their means. Sums go from the first row to the last.
template <typename Values>
FrameMatrixD centred(const Values& values) {
  FrameMatrixD result = values.template cast<double>();
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(result.cols());
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    sum += result.row(i);
  }
  if (result.rows() > 0) {
    result.rowwise() -= sum / static_cast<double>(result.rows());
  }
  return result;
}

// a' b without Eigen's blocks, whose size is that of the machine's caches.
Eigen::MatrixXd summed_products(const FrameMatrixD& a, const FrameMatrixD& b) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index column = 0; column < b.cols(); ++column) {
      sum.col(column) += a.row(i).transpose() * b(i, column);
    }
  }
  return sum;
}

// The two eigenvectors of largest eigenvalue of the columns' covariance (#columns by 2; the second
// is 0 where there is one column alone).
Eigen::MatrixXd principal_axes(const FrameMatrixD& values) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(summed_products(values, values));
  Eigen::MatrixXd axes = Eigen::MatrixXd::Zero(values.cols(), 2);
  for (Eigen::Index axis = 0; axis < std::min<Eigen::Index>(2, values.cols()); ++axis) {
    axes.col(axis) = solver.eigenvectors().col(values.cols() - 1 - axis);
  }
  return axes;
}

MapPlaces along(const FrameMatrixD& values, const Eigen::MatrixXd& axes) {
  MapPlaces places(values.rows(), 2);
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    places.row(i) = values.row(i).lazyProduct(axes);
  }
  return places;
}

} // namespace

MapPlaces pca_places(const FrameMatrix& points) {
  const FrameMatrixD values = centred(points);
  MapPlaces places = along(values, principal_axes(values));
  orient_axes(places, points);
  return places;
}

void centre_and_align(MapPlaces& places) {
  const FrameMatrixD values = centred(places);
  places = along(values, principal_axes(values));
}

void orient_axes(MapPlaces& places, const FrameMatrix& points) {
  const Eigen::MatrixXd covariance = summed_products(centred(points), centred(places));
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    double strongest = 0.0;
    for (Eigen::Index dimension = 0; dimension < covariance.rows(); ++dimension) {
      if (std::abs(covariance(dimension, axis)) > std::abs(strongest)) {
        strongest = covariance(dimension, axis);
      }
    }
    if (strongest < 0.0) {
      places.col(axis) *= -1.0;
    }
  }
}

} // namespace phonomime
