// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/classical_scaling.h"

#include "db/types/errors.h"
#include "db/types/parallel_for.h"
#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Spectra/SymEigsSolver.h>

namespace phonomime {

namespace {

constexpr Eigen::Index kRowsAtOnce = 64; // a thread's share
constexpr Eigen::Index kSmall = 40;      // points up to which all eigenvalues are found
// B, scaled to trace 1, plus this times the identity: the same eigenvectors, and an eigenvalue of 0
// can converge in relation to its size.
constexpr double kShift = 1e-3;
// An axis whose squared length is less than this share of the other's is rounding.
constexpr double kFlat = 1e-12;

// Sum over j of d[j]^2 x[j].
PHONOMIME_DISPATCHED double squares_times(const double* d, const double* x, std::size_t count) {
  DoubleLanes sums[4] = {};
  std::size_t j = 0;
  for (; j + 4 * kDoubleLanes <= count; j += 4 * kDoubleLanes) {
    for (std::size_t part = 0; part < 4; ++part) {
      DoubleLanes distance, value;
      load(distance, d + j + part * kDoubleLanes);
      load(value, x + j + part * kDoubleLanes);
      sums[part] += distance * distance * value;
    }
  }
  double rest = 0.0;
  for (; j < count; ++j) {
    rest += d[j] * d[j] * x[j];
  }
  return sum_of_lanes((sums[0] + sums[1]) + (sums[2] + sums[3])) + rest;
}

double mean(const Eigen::VectorXd& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value;
  }
  return sum / static_cast<double>(values.size());
}

// B / trace + shift, as Spectra takes an operator.
class CentredSquares {
public:
  using Scalar = double;

  CentredSquares(const DistanceMatrix& distances, int threads)
      : distances_(distances), threads_(threads) {
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(rows());
    trace_ = 0.5 * mean(squared_distances_times(ones));
  }

  Eigen::Index rows() const { return distances_.rows(); }
  Eigen::Index cols() const { return distances_.cols(); }
  double trace() const { return trace_; }

  void perform_op(const double* x, double* y) const {
    const Eigen::Map<const Eigen::VectorXd> given(x, rows());
    Eigen::VectorXd value = given;
    value.array() -= mean(value);
    Eigen::VectorXd product = squared_distances_times(value);
    product.array() -= mean(product);
    Eigen::Map<Eigen::VectorXd>(y, rows()) = (-0.5 / trace_) * product + kShift * given;
  }

private:
  Eigen::VectorXd squared_distances_times(const Eigen::VectorXd& x) const {
    Eigen::VectorXd product(rows());
    parallel_for((rows() + kRowsAtOnce - 1) / kRowsAtOnce, threads_, [&](std::ptrdiff_t share) {
      const Eigen::Index first = share * kRowsAtOnce;
      for (Eigen::Index i = first; i < std::min(first + kRowsAtOnce, rows()); ++i) {
        product[i] =
            squares_times(distances_.row(i).data(), x.data(), static_cast<std::size_t>(cols()));
      }
    });
    return product;
  }

  const DistanceMatrix& distances_;
  int threads_;
  double trace_ = 0.0;
};

struct TwoEigenpairs {
  Eigen::MatrixXd vectors; // #points by 2
  Eigen::Vector2d values;  // of the operator, largest first
};

TwoEigenpairs all_at_once(const CentredSquares& matrix) {
  Eigen::MatrixXd dense(matrix.rows(), matrix.rows());
  for (Eigen::Index column = 0; column < matrix.rows(); ++column) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(matrix.rows(), column);
    matrix.perform_op(unit.data(), dense.col(column).data());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (dense + dense.transpose()));
  return {solver.eigenvectors().rightCols(2).rowwise().reverse(),
          solver.eigenvalues().tail(2).reverse()};
}

std::optional<TwoEigenpairs> largest_two(CentredSquares& matrix, double tolerance, int restarts) {
  // Vectors of the Krylov space; the two converge before it is full where few axes matter, as here.
  constexpr int kBasis = 10;
  Spectra::SymEigsSolver<CentredSquares> solver(matrix, 2, kBasis);
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge, restarts, tolerance);
  if (solver.info() != Spectra::CompInfo::Successful) {
    return std::nullopt;
  }
  return TwoEigenpairs{solver.eigenvectors(), solver.eigenvalues()};
}

TwoEigenpairs eigenpairs(CentredSquares& matrix) {
  if (matrix.rows() <= kSmall) {
    return all_at_once(matrix);
  }
  // A second and third eigenvalue that are next to equal do not come apart; then any two directions
  // of theirs are as good.
  auto pairs = largest_two(matrix, 1e-10, 120);
  if (!pairs) {
    pairs = largest_two(matrix, 1e-4, 600);
  }
  if (!pairs) {
    throw InternalError({.where = "classical scaling", .what = "the eigenvalues do not converge"});
  }
  return *std::move(pairs);
}

} // namespace

ScaledPlaces classical_scaling(const DistanceMatrix& distances, int threads) {
  ScaledPlaces result;
  result.places = MapPlaces::Zero(distances.rows(), 2);
  if (distances.rows() < 2) {
    return result;
  }
  CentredSquares matrix(distances, threads);
  if (matrix.trace() <= 0.0) {
    return result;
  }
  const TwoEigenpairs pairs = eigenpairs(matrix);
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    const double value = pairs.values[axis] - kShift;
    if (value > kFlat * std::max(0.0, pairs.values[0] - kShift)) {
      result.eigenvalues[static_cast<std::size_t>(axis)] = value * matrix.trace();
      result.places.col(axis) = pairs.vectors.col(axis) * std::sqrt(value * matrix.trace());
    }
  }
  return result;
}

} // namespace phonomime
