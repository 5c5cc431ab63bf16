// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/smoothing_spline.h"

#include "db/types/errors.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace phonomime {
namespace {

// L D L^T of the symmetric positive definite band matrix A = R + Q^T W^-1 Q of order n - 2, where
// Q's columns are second differences (1, -2, 1) and R holds the splines' 2/3 and 1/6.
class ReinschSystem {
public:
  explicit ReinschSystem(std::span<const double> weights) {
    const std::size_t order = weights.size() - 2;
    pivot_.resize(order);
    below_.resize(order);
    two_below_.resize(order);
    for (std::size_t j = 0; j < order; ++j) {
      const double v0 = 1.0 / weights[j];
      const double v1 = 1.0 / weights[j + 1];
      const double v2 = 1.0 / weights[j + 2];
      double diagonal = 2.0 / 3.0 + v0 + 4.0 * v1 + v2;
      double next = 1.0 / 6.0 - 2.0 * v1 - 2.0 * v2; // A(j, j + 1)
      if (j >= 1) {
        diagonal -= pivot_[j - 1] * below_[j - 1] * below_[j - 1];
        next -= pivot_[j - 1] * below_[j - 1] * two_below_[j - 1];
      }
      if (j >= 2) {
        diagonal -= pivot_[j - 2] * two_below_[j - 2] * two_below_[j - 2];
      }
      pivot_[j] = diagonal;
      below_[j] = next / diagonal;
      two_below_[j] = v2 / diagonal; // A(j, j + 2) = 1 / W_{j+2}
    }
  }

  // Solves A x = b in place. `b`: (n - 2) by #dimensions.
  void solve(FrameMatrixD& b) const {
    const Eigen::Index order = b.rows();
    for (Eigen::Index j = 1; j < order; ++j) {
      b.row(j) -= below_[j - 1] * b.row(j - 1);
      if (j >= 2) {
        b.row(j) -= two_below_[j - 2] * b.row(j - 2);
      }
    }
    for (Eigen::Index j = order - 1; j >= 0; --j) {
      b.row(j) /= pivot_[j];
      if (j + 1 < order) {
        b.row(j) -= below_[j] * b.row(j + 1);
      }
      if (j + 2 < order) {
        b.row(j) -= two_below_[j] * b.row(j + 2);
      }
    }
  }

private:
  std::vector<double> pivot_;     // D
  std::vector<double> below_;     // L(j + 1, j)
  std::vector<double> two_below_; // L(j + 2, j)
};

void check(Eigen::Index frames, std::span<const double> weights) {
  if (frames != static_cast<Eigen::Index>(weights.size())) {
    throw InternalError({.what = "smoothing weights do not fit the frames",
                         .expected = std::to_string(frames),
                         .got = std::to_string(weights.size())});
  }
  if (!std::all_of(weights.begin(), weights.end(), [](double w) { return w > 0.0; })) {
    throw InternalError({.what = "a smoothing weight is not positive"});
  }
}

} // namespace

void fit_smoothing_spline(Eigen::Ref<FrameMatrixD> frames, std::span<const double> weights) {
  check(frames.rows(), weights);
  const Eigen::Index order = frames.rows() - 2;
  if (order < 1) {
    return;
  }
  FrameMatrixD curvature(order, frames.cols()); // Q^T f, then gamma = g'' at the inner frames
  for (Eigen::Index j = 0; j < order; ++j) {
    curvature.row(j) =
        (frames.row(j + 2) - frames.row(j + 1)) - (frames.row(j + 1) - frames.row(j));
  }
  ReinschSystem(weights).solve(curvature);
  for (Eigen::Index j = 0; j < order; ++j) { // g = f - W^-1 Q gamma
    frames.row(j) -= curvature.row(j) / weights[j];
    frames.row(j + 1) += 2.0 * curvature.row(j) / weights[j + 1];
    frames.row(j + 2) -= curvature.row(j) / weights[j + 2];
  }
}

} // namespace phonomime
