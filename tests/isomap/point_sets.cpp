// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/isomap/point_sets.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>
#include <Eigen/SVD>

namespace phonomime::test {

namespace {

Eigen::MatrixXd random_matrix(std::mt19937& random, Eigen::Index rows, Eigen::Index cols) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd matrix(rows, cols);
  std::generate_n(matrix.data(), matrix.size(), [&] { return normal(random); });
  return matrix;
}

} // namespace

FrameMatrix uniform_points(std::mt19937& random, int count, int dimensions, double size) {
  std::uniform_real_distribution<double> uniform(0.0, size);
  FrameMatrix points(count, dimensions);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index d = 0; d < dimensions; ++d) {
      points(i, d) = static_cast<float>(uniform(random));
    }
  }
  return points;
}

FrameMatrix trajectory_points(std::mt19937& random, int nodes, int frames_a_node, int dimensions) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd spread = random_matrix(random, 4, dimensions);
  FrameMatrix points(nodes * frames_a_node, dimensions);
  for (int node = 0; node < nodes; ++node) {
    const double u0 = 6.0 * normal(random), v0 = 2.5 * normal(random);
    const double du = normal(random), dv = normal(random);
    for (int frame = 0; frame < frames_a_node; ++frame) {
      const double t = static_cast<double>(frame) / frames_a_node;
      const double u = u0 + 2.0 * du * t, v = v0 + 2.0 * dv * t + std::sin(3.0 * t);
      const Eigen::RowVector4d sheet(u, v, 0.08 * u * u, std::sin(0.4 * v) * 2.0);
      for (int d = 0; d < dimensions; ++d) {
        points(node * frames_a_node + frame, d) =
            static_cast<float>(sheet.dot(spread.col(d)) + 0.1 * normal(random));
      }
    }
  }
  return points;
}

SwissRoll swiss_roll(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> uniform;
  SwissRoll roll = {FrameMatrix(count, 3), MapPlaces(count, 2)};
  const auto arc = [](double t) { return 0.5 * (t * std::sqrt(1.0 + t * t) + std::asinh(t)); };
  for (Eigen::Index i = 0; i < count; ++i) {
    // Uniform on the sheet: the angle at a share of the whole length, by bisection.
    double low = 4.7, high = 14.1;
    const double length = arc(low) + uniform(random) * (arc(high) - arc(low));
    for (int halving = 0; halving < 60; ++halving) {
      (arc(0.5 * (low + high)) < length ? low : high) = 0.5 * (low + high);
    }
    const double height = 20.0 * uniform(random);
    roll.points.row(i) =
        Eigen::RowVector3d(low * std::cos(low), height, low * std::sin(low)).cast<float>();
    roll.sheet.row(i) << length, height;
  }
  return roll;
}

FrameMatrix lay_into_space(std::mt19937& random, const MapPlaces& places, int dimensions) {
  const Eigen::MatrixXd turn =
      random_matrix(random, dimensions, dimensions).householderQr().householderQ();
  const Eigen::RowVectorXd move = random_matrix(random, 1, dimensions);
  return ((places * turn.topRows(2)).rowwise() + move).cast<float>();
}

double misfit(const MapPlaces& a, const MapPlaces& b) {
  const MapPlaces from = a.rowwise() - a.colwise().mean();
  const MapPlaces to = b.rowwise() - b.colwise().mean();
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(from.transpose() * to,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const MapPlaces fitted = from * (svd.matrixU() * svd.matrixV().transpose());
  const double scale = std::sqrt(to.rowwise().squaredNorm().mean());
  return (fitted - to).rowwise().norm().maxCoeff() / scale;
}

} // namespace phonomime::test
