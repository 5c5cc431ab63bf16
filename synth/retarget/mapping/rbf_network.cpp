// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/rbf_network.h"

#include "db/types/errors.h"
#include "db/types/percentile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Eigenvalues>

namespace phonomime {
namespace {

constexpr Eigen::Index kRowsAtOnce = 128; // of points: their distances stay in the cache

// Lambda over the largest squared eigenvalue of H. Under the least one nothing but rounding is fit.
constexpr double kLeastLambda = 1e-10;
constexpr double kLargestLambda = 1e3;
constexpr int kMostSteps = 200;
constexpr double kGcvRests = 1e-10; // relative change at which the estimation ends

// Sigma over the median distance of two centres.
constexpr double kLeastSigma = 0.125;
constexpr int kSigmaSteps = 13;
constexpr int kGoldenSteps = 12;

// Of the series of exp(-r), innermost first.
constexpr std::array<double, 7> kReciprocals = {1.0 / 7, 1.0 / 6, 1.0 / 5, 1.0 / 4,
                                                1.0 / 3, 1.0 / 2, 1.0};

// exp(-t) for t >= 0 to 1e-12 of its value, and 0 in effect from t = 64 on: of additions and
// multiplications alone, because the C library's takes another path on machines with fused
// multiply-add, and the same input must give the same bytes on every machine.
void exp_minus(FrameMatrixD& t) {
  auto flat = Eigen::Map<Eigen::ArrayXd>(t.data(), t.size());
  const auto chunk = [](auto part) {
    const Eigen::Array<double, 8, 1> r = part.max(0.0).min(64.0) * (1.0 / 1024.0);
    Eigen::Array<double, 8, 1> value = Eigen::Array<double, 8, 1>::Ones();
    for (const double reciprocal : kReciprocals) {
      value = 1.0 - r * reciprocal * value;
    }
    for (int doubling = 0; doubling < 10; ++doubling) {
      value *= value;
    }
    part = value;
  };
  const Eigen::Index whole = flat.size() / 8 * 8;
  for (Eigen::Index i = 0; i < whole; i += 8) {
    chunk(flat.segment<8>(i));
  }
  if (whole < flat.size()) {
    Eigen::Array<double, 8, 1> rest = Eigen::Array<double, 8, 1>::Zero();
    rest.head(flat.size() - whole) = flat.tail(flat.size() - whole);
    chunk(rest.segment<8>(0));
    flat.tail(flat.size() - whole) = rest.head(flat.size() - whole);
  }
}

// phi_k of each point: #points by #centres.
FrameMatrixD basis_at(const FrameMatrixD& points, const FrameMatrixD& centres, double sigma) {
  const FrameMatrixD by_input = centres.transpose();
  FrameMatrixD exponent = FrameMatrixD::Zero(points.rows(), centres.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    for (Eigen::Index d = 0; d < points.cols(); ++d) {
      exponent.row(i).array() += (by_input.row(d).array() - points(i, d)).square();
    }
  }
  exponent *= 0.5 / (sigma * sigma);
  exp_minus(exponent);
  return exponent;
}

// H in its own axes: H = Q diag(s) Q^T, which makes GCV a sum over s.
struct Spectrum {
  Eigen::ArrayXd s_sq;
  Eigen::ArrayXd s;
  Eigen::MatrixXd axes;

  Spectrum(const FrameMatrixD& centres, double sigma) {
    const Eigen::MatrixXd h = basis_at(centres, centres, sigma);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (h + h.transpose()));
    s = eigen.eigenvalues().array();
    s_sq = s.square();
    axes = eigen.eigenvectors();
  }
};

struct Ridge {
  double lambda = 0.0;
  double gcv = std::numeric_limits<double>::infinity();
};

// `z`: the output in the axes of H.
double gcv_at(const Spectrum& spectrum, const Eigen::ArrayXd& z, double lambda) {
  const Eigen::ArrayXd left = lambda / (spectrum.s_sq + lambda); // eigenvalues of I - A
  const double trace = left.sum();
  return static_cast<double>(z.size()) * (left * z).square().sum() / (trace * trace);
}

// The lambda at which GCV's derivative would be zero, were its other terms as they are at `lambda`.
double estimate_again(const Spectrum& spectrum, const Eigen::ArrayXd& z, double lambda) {
  const Eigen::ArrayXd inverse = 1.0 / (spectrum.s_sq + lambda);
  const Eigen::ArrayXd left = lambda * inverse;
  const double above = (left * z).square().sum() * (spectrum.s_sq * inverse.square()).sum();
  const double below = (spectrum.s_sq * z.square() * inverse.cube()).sum() * left.sum();
  return above / below;
}

Ridge choose_ridge(const Spectrum& spectrum, const Eigen::ArrayXd& z) {
  const double scale = spectrum.s_sq.maxCoeff();
  const double least = kLeastLambda * scale;
  const double largest = kLargestLambda * scale;
  Ridge best{.lambda = largest};
  if (z.square().sum() == 0.0) {
    return {.lambda = largest, .gcv = 0.0}; // a shape that no pair uses
  }
  const double half_decade = std::sqrt(10.0);
  for (double lambda = least; lambda <= largest; lambda *= half_decade) {
    if (const double gcv = gcv_at(spectrum, z, lambda); gcv < best.gcv) {
      best = {.lambda = lambda, .gcv = gcv};
    }
  }
  Ridge now = best;
  for (int step = 0; step < kMostSteps; ++step) {
    const double lambda = std::clamp(estimate_again(spectrum, z, now.lambda), least, largest);
    const double gcv = gcv_at(spectrum, z, lambda);
    const bool rests = std::abs(gcv - now.gcv) <= kGcvRests * now.gcv;
    now = {.lambda = lambda, .gcv = gcv};
    if (gcv < best.gcv) {
      best = now;
    }
    if (rests) {
      break;
    }
  }
  return best;
}

std::vector<Ridge> choose_ridges(const Spectrum& spectrum, const Eigen::MatrixXd& rotated) {
  std::vector<Ridge> ridges;
  for (Eigen::Index j = 0; j < rotated.cols(); ++j) {
    ridges.push_back(choose_ridge(spectrum, rotated.col(j).array()));
  }
  return ridges;
}

double total_gcv(const FrameMatrixD& centres, const FrameMatrixD& outputs, double sigma) {
  const Spectrum spectrum(centres, sigma);
  double sum = 0.0;
  for (const Ridge& ridge : choose_ridges(spectrum, spectrum.axes.transpose() * outputs)) {
    sum += ridge.gcv;
  }
  return sum;
}

double median_distance(const FrameMatrixD& centres) {
  std::vector<double> distances;
  for (Eigen::Index i = 0; i < centres.rows(); ++i) {
    for (Eigen::Index k = i + 1; k < centres.rows(); ++k) {
      if (const double distance = (centres.row(i) - centres.row(k)).norm(); distance > 0.0) {
        distances.push_back(distance);
      }
    }
  }
  return percentile(std::move(distances), 0.5).value_or(0.0);
}

// The sigma of the least total GCV: the best of a row, each larger than the one before by the root
// of 2, then golden section between its neighbours.
double choose_sigma(const FrameMatrixD& centres, const FrameMatrixD& outputs) {
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  double sigma = kLeastSigma * median_distance(centres);
  for (int step = 0; step < kSigmaSteps; ++step, sigma *= std::sqrt(2.0)) {
    if (const double gcv = total_gcv(centres, outputs, sigma); gcv < least) {
      least = gcv;
      best = sigma;
    }
  }
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double low = best / std::sqrt(2.0);
  double high = best * std::sqrt(2.0);
  double a = high - golden * (high - low);
  double b = low + golden * (high - low);
  double gcv_a = total_gcv(centres, outputs, a);
  double gcv_b = total_gcv(centres, outputs, b);
  for (int step = 0; step < kGoldenSteps; ++step) {
    if (gcv_a <= gcv_b) {
      high = b;
      b = a;
      gcv_b = gcv_a;
      a = high - golden * (high - low);
      gcv_a = total_gcv(centres, outputs, a);
    } else {
      low = a;
      a = b;
      gcv_a = gcv_b;
      b = low + golden * (high - low);
      gcv_b = total_gcv(centres, outputs, b);
    }
  }
  return std::min(gcv_a, gcv_b) < least ? (gcv_a <= gcv_b ? a : b) : best;
}

} // namespace

RbfNetwork::RbfNetwork(const FrameMatrixD& centres, const FrameMatrixD& outputs, double sigma)
    : centres_(centres), outputs_(outputs), sigma_(sigma) {
  if (centres.rows() < 2 || centres.rows() != outputs.rows() || !(sigma >= 0.0) ||
      !centres.allFinite() || !outputs.allFinite() ||
      (centres.rowwise() - centres.row(0)).squaredNorm() == 0.0) {
    throw InternalError({.what = "centres and outputs that no network can be made of"});
  }
  if (sigma_ == 0.0) {
    sigma_ = choose_sigma(centres, outputs);
  }
  const Spectrum spectrum(centres_, sigma_);
  const Eigen::MatrixXd rotated = spectrum.axes.transpose() * outputs_;
  const std::vector<Ridge> ridges = choose_ridges(spectrum, rotated);
  lambda_.resize(outputs_.cols());
  Eigen::MatrixXd scaled(rotated.rows(), rotated.cols());
  for (Eigen::Index j = 0; j < outputs_.cols(); ++j) {
    const Ridge& ridge = ridges[static_cast<std::size_t>(j)];
    lambda_(j) = ridge.lambda;
    gcv_ += ridge.gcv;
    scaled.col(j) = (spectrum.s / (spectrum.s_sq + ridge.lambda) * rotated.col(j).array()).matrix();
  }
  weights_ = spectrum.axes * scaled; // X6
}

FrameMatrixD RbfNetwork::at(const FrameMatrixD& points) const {
  FrameMatrixD result(points.rows(), weights_.cols());
  for (Eigen::Index first = 0; first < points.rows(); first += kRowsAtOnce) {
    const Eigen::Index count = std::min(kRowsAtOnce, points.rows() - first);
    result.middleRows(first, count).noalias() =
        basis_at(points.middleRows(first, count), centres_, sigma_) * weights_; // X4
  }
  return result;
}

FrameMatrixD RbfNetwork::left_out() const {
  const Spectrum spectrum(centres_, sigma_);
  FrameMatrixD result(outputs_.rows(), outputs_.cols());
  for (Eigen::Index j = 0; j < outputs_.cols(); ++j) {
    const Eigen::VectorXd left = (lambda_(j) / (spectrum.s_sq + lambda_(j))).matrix();
    const Eigen::VectorXd residual =
        spectrum.axes * left.cwiseProduct(spectrum.axes.transpose() * outputs_.col(j));
    const Eigen::VectorXd diagonal = spectrum.axes.cwiseAbs2() * left; // of I - A
    result.col(j) = outputs_.col(j) - residual.cwiseQuotient(diagonal);
  }
  return result;
}

} // namespace phonomime
