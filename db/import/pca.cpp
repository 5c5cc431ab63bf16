// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/pca.h"

#include "db/types/errors.h"
#include "db/types/frame_products.h"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace phonomime {

namespace {

constexpr Eigen::Index kFramesAtOnce = 4096;
constexpr Eigen::Index kOriginFrames = 512;

} // namespace

CovarianceAccumulator::CovarianceAccumulator(Eigen::Index channel_count, int threads)
    : channel_count_(channel_count), threads_(threads), waiting_(kFramesAtOnce, channel_count),
      sum_(Eigen::VectorXd::Zero(channel_count)),
      product_sum_(Eigen::MatrixXd::Zero(channel_count, channel_count)) {}

void CovarianceAccumulator::add(const FrameMatrix& channels,
                                const std::vector<std::uint8_t>& leave_out) {
  for (Eigen::Index k = 0; k < channels.rows(); ++k) {
    if (leave_out[static_cast<std::size_t>(k)] != 0) {
      ++left_out_;
      continue;
    }
    waiting_.row(waiting_count_++) = channels.row(k).cast<double>();
    ++frames_;
    if (waiting_count_ == waiting_.rows()) {
      flush();
    }
  }
}

void CovarianceAccumulator::flush() {
  if (waiting_count_ == 0) {
    return;
  }
  if (origin_.size() == 0) {
    origin_ =
        waiting_.topRows(std::min(kOriginFrames, waiting_count_)).colwise().mean().transpose();
  }
  const FrameMatrixD centred = waiting_.topRows(waiting_count_).rowwise() - origin_.transpose();
  sum_ += centred.colwise().sum().transpose();
  product_sum_ += frame_products(centred, threads_);
  waiting_count_ = 0;
}

FrameStatistics CovarianceAccumulator::finish() {
  flush();
  FrameStatistics result;
  result.frames = frames_;
  result.left_out = left_out_;
  result.mean = Eigen::VectorXd::Zero(channel_count_);
  result.covariance = Eigen::MatrixXd::Zero(channel_count_, channel_count_);
  if (frames_ > 0) {
    const Eigen::VectorXd shift = sum_ / static_cast<double>(frames_);
    result.mean = origin_ + shift;
    const Eigen::MatrixXd covariance = product_sum_ / static_cast<double>(frames_);
    result.covariance = covariance - shift * shift.transpose();
  }
  return result;
}

PcaModel fit_pca(const FrameStatistics& statistics, const PcaSize& size) {
  if (statistics.frames == 0) {
    throw InputError({.what = "there is no frame to fit the PCA to",
                      .expected = "at least one sentence without gaps throughout",
                      .remedy = "Look at the gaps in the import report."});
  }
  const Eigen::Index channel_count = statistics.mean.size();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(statistics.covariance);
  if (solver.info() != Eigen::Success) {
    throw InternalError({.what = "the eigenvalues of the covariance do not converge"});
  }
  // Eigen gives them smallest first; rounding may leave the least ones just below zero.
  const Eigen::VectorXd variance = solver.eigenvalues().reverse().cwiseMax(0.0);
  PcaModel model;
  model.mean = statistics.mean;
  model.total_variance = variance.sum();
  Eigen::Index dimensions = std::min<Eigen::Index>(size.dimensions, channel_count);
  if (size.share) {
    double explained = variance(0);
    for (dimensions = 1;
         dimensions < channel_count && explained < *size.share * model.total_variance;
         ++dimensions) {
      explained += variance(dimensions);
    }
  }
  model.variance = variance.head(dimensions);
  model.basis = solver.eigenvectors().rowwise().reverse().leftCols(dimensions);
  for (Eigen::Index d = 0; d < dimensions; ++d) {
    Eigen::Index largest = 0;
    model.basis.col(d).cwiseAbs().maxCoeff(&largest);
    if (model.basis(largest, d) < 0.0) {
      model.basis.col(d) = -model.basis.col(d);
    }
  }
  return model;
}

double explained_share(const PcaModel& model) {
  return model.total_variance > 0.0 ? model.variance.sum() / model.total_variance : 1.0;
}

} // namespace phonomime
