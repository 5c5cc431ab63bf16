// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/curation/neighbour_model.h"

#include "db/curation/robust.h"
#include "db/types/frame_products.h"
#include "db/types/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

namespace phonomime {

namespace {

constexpr Eigen::Index kLeastFrames = 200;
constexpr std::size_t kNearest = 8;
constexpr std::size_t kMostCompanions = 2;
constexpr double kLeastTogether = 0.5; // of what each has left over
constexpr int kTrimmings = 2;
constexpr double kKeptShare = 0.9;
// docs/curation.md says what the limits were chosen by.
constexpr double kUsualTimes = 12.0;
constexpr double kLeastMarkerLimit = 0.5; // mm
constexpr double kLeastWeightLimit = 0.1;
constexpr double kTailShare = 0.99;
constexpr double kTailTimes = 3.0;
// What the prediction may be off by where neighbours say nothing: the ridge.
constexpr double kMarkerNoise = 0.05; // mm
constexpr double kWeightNoise = 0.005;

double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

} // namespace

NeighbourModel::NeighbourModel(const FrameMatrix& frames, const Layout& layout, int threads)
    : markers_(layout.kind == LayoutKind::markers), width_(layout.channels_per_group()) {
  const auto groups = static_cast<std::size_t>(layout.group_count());
  usual_.assign(groups, 0.0);
  limit_.assign(groups, std::numeric_limits<double>::infinity());
  known_ = frames.rows() >= kLeastFrames && groups >= 2;
  if (!known_) {
    return;
  }
  centre_.resize(frames.cols());
  for (Eigen::Index c = 0; c < frames.cols(); ++c) {
    const Eigen::VectorXd column = frames.col(c).cast<double>();
    centre_[c] = median({column.begin(), column.end()});
  }
  const FrameMatrixD centred = frames.cast<double>().rowwise() - centre_.transpose();
  fits_.resize(groups);
  choose_nearest(centred);
  add_companions(centred, threads);
  parallel_for(layout.group_count(), threads, [&](std::ptrdiff_t group) {
    const auto at = static_cast<std::size_t>(group);
    const FrameMatrixD left = fit(static_cast<int>(group), centred);
    std::vector<double> lengths(static_cast<std::size_t>(left.rows()));
    for (Eigen::Index k = 0; k < left.rows(); ++k) {
      lengths[static_cast<std::size_t>(k)] = left.row(k).norm();
    }
    usual_[at] = median(lengths);
    // A weight may rest at nothing for most of the time: then the median says nothing.
    const double least = markers_ ? kLeastMarkerLimit
                                  : std::max(kLeastWeightLimit,
                                             kTailTimes * quantile(std::move(lengths), kTailShare));
    limit_[at] = std::max(least, kUsualTimes * usual_[at]);
  });
  readers_.resize(groups);
  for (std::size_t group = 0; group < groups; ++group) {
    for (std::size_t i = 0; i < fits_[group].neighbours.size(); ++i) {
      readers_[static_cast<std::size_t>(fits_[group].neighbours[i])].push_back(
          {static_cast<int>(group), static_cast<int>(i)});
    }
  }
}

void NeighbourModel::choose_nearest(const FrameMatrixD& centred) {
  const auto groups = static_cast<int>(fits_.size());
  const auto farness = [&](int a, int b) {
    if (markers_) {
      return (centre_.segment(3 * a, 3) - centre_.segment(3 * b, 3)).norm();
    }
    const double alone = centred.col(a).norm() * centred.col(b).norm();
    return alone > 0.0 ? 1.0 - std::abs(centred.col(a).dot(centred.col(b))) / alone : 1.0;
  };
  for (int group = 0; group < groups; ++group) {
    std::vector<std::pair<double, int>> others;
    for (int other = 0; other < groups; ++other) {
      if (other != group) {
        others.emplace_back(farness(group, other), other);
      }
    }
    std::ranges::sort(others);
    others.resize(std::min(kNearest, others.size()));
    for (const auto& [far, other] : others) {
      fits_[static_cast<std::size_t>(group)].neighbours.push_back(other);
    }
  }
}

void NeighbourModel::add_companions(const FrameMatrixD& centred, int threads) {
  const auto groups = static_cast<int>(fits_.size());
  FrameMatrixD left(centred.rows(), centred.cols());
  parallel_for(groups, threads, [&](std::ptrdiff_t group) {
    left.middleCols(group * width_, width_) = fit(static_cast<int>(group), centred);
  });
  // How much of two groups moves together, 0 to 1: the norm of their covariance over those of their
  // own.
  const Eigen::MatrixXd products = frame_products(left, threads);
  Eigen::MatrixXd together(groups, groups);
  for (int a = 0; a < groups; ++a) {
    for (int b = 0; b < groups; ++b) {
      together(a, b) = products.block(a * width_, b * width_, width_, width_).norm();
    }
  }
  for (int group = 0; group < groups; ++group) {
    std::vector<int>& neighbours = fits_[static_cast<std::size_t>(group)].neighbours;
    std::vector<std::pair<double, int>> companions;
    for (int other = 0; other < groups; ++other) {
      const double own = std::sqrt(together(group, group) * together(other, other));
      if (other != group && together(group, other) > kLeastTogether * own &&
          std::ranges::find(neighbours, other) == neighbours.end()) {
        companions.emplace_back(-together(group, other) / own, other);
      }
    }
    std::ranges::sort(companions);
    companions.resize(std::min(kMostCompanions, companions.size()));
    for (const auto& [negative, other] : companions) {
      neighbours.push_back(other);
    }
  }
}

FrameMatrixD NeighbourModel::fit(int group, const FrameMatrixD& centred) {
  Fit& fit = fits_[static_cast<std::size_t>(group)];
  const auto inputs = static_cast<Eigen::Index>(fit.neighbours.size()) * width_;
  const double noise = markers_ ? kMarkerNoise : kWeightNoise;
  // One row a frame: the neighbours' channels, then the group's own.
  FrameMatrixD rows(centred.rows(), inputs + width_);
  for (std::size_t i = 0; i < fit.neighbours.size(); ++i) {
    rows.middleCols(static_cast<Eigen::Index>(i) * width_, width_) =
        centred.middleCols(fit.neighbours[i] * width_, width_);
  }
  rows.rightCols(width_) = centred.middleCols(group * width_, width_);
  FrameMatrixD usual(rows.rows(), rows.cols()), left(rows.rows(), width_);
  std::vector<double> lengths(static_cast<std::size_t>(rows.rows()), 0.0);
  double most = std::numeric_limits<double>::infinity();
  for (int trimming = 0; trimming <= kTrimmings; ++trimming) {
    Eigen::Index kept = 0;
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
      if (lengths[static_cast<std::size_t>(k)] <= most) {
        usual.row(kept++) = rows.row(k);
      }
    }
    const Eigen::MatrixXd moments = frame_products(usual.topRows(kept), 1);
    Eigen::MatrixXd normal = moments.topLeftCorner(inputs, inputs);
    normal.diagonal().array() += static_cast<double>(kept) * noise * noise;
    fit.weights = normal.llt().solve(moments.topRightCorner(inputs, width_));
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
      for (int c = 0; c < width_; ++c) {
        left(k, c) = rows(k, inputs + c);
      }
      for (Eigen::Index i = 0; i < inputs; ++i) {
        for (int c = 0; c < width_; ++c) {
          left(k, c) -= fit.weights(i, c) * rows(k, i);
        }
      }
      lengths[static_cast<std::size_t>(k)] = left.row(k).norm();
    }
    most = quantile(lengths, kKeptShare);
  }
  return left;
}

FrameMatrixD NeighbourModel::residuals(const FrameMatrix& frames) const {
  // Channel by channel, all frames of one together in memory: for the compiler's vectors. The sums
  // of a frame keep their order.
  const Eigen::MatrixXf centred =
      (frames.cast<double>().rowwise() - centre_.transpose()).cast<float>();
  Eigen::MatrixXf left = centred;
  for (std::size_t group = 0; group < fits_.size(); ++group) {
    const Fit& fit = fits_[group];
    for (std::size_t i = 0; i < fit.neighbours.size(); ++i) {
      for (int from = 0; from < width_; ++from) {
        const auto neighbour = centred.col(fit.neighbours[i] * width_ + from);
        for (int to = 0; to < width_; ++to) {
          const double weight = fit.weights(static_cast<Eigen::Index>(i) * width_ + from, to);
          left.col(static_cast<Eigen::Index>(group) * width_ + to) -=
              static_cast<float>(weight) * neighbour;
        }
      }
    }
  }
  return left.cast<double>();
}

void NeighbourModel::take_off(int group, const Eigen::VectorXd& displacement,
                              double* residual) const {
  for (int c = 0; c < width_; ++c) {
    residual[group * width_ + c] -= displacement[c];
  }
  for (const Reader& reader : readers_[static_cast<std::size_t>(group)]) {
    const Eigen::MatrixXd& weights = fits_[static_cast<std::size_t>(reader.group)].weights;
    for (int to = 0; to < width_; ++to) {
      for (int from = 0; from < width_; ++from) {
        residual[reader.group * width_ + to] +=
            weights(reader.position * width_ + from, to) * displacement[from];
      }
    }
  }
}

} // namespace phonomime
