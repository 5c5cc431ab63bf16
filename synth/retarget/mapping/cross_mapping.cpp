// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/cross_mapping.h"

#include "db/types/errors.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

namespace phonomime {
namespace {

constexpr Eigen::Index kFewestPairs = 3;
constexpr int kMostTrials = 16;    // dimensions that cross-validation looks at
constexpr double kNoBetter = 1.02; // the fewest dimensions this near the least error are taken
constexpr Eigen::Index kRowsAtOnce = 256;

PcaModel leading(const PcaModel& pca, int dimensions) {
  PcaModel cut = pca;
  cut.basis = pca.basis.leftCols(dimensions);
  cut.variance = pca.variance.head(std::min<Eigen::Index>(pca.variance.size(), dimensions));
  return cut;
}

// X3 for many frames: #frames by #dimensions.
FrameMatrixD project(const PcaModel& pca, const FrameMatrixD& channels) {
  return (channels.rowwise() - pca.mean.transpose()) * pca.basis;
}

double rms_left_out(const RbfNetwork& network, const FrameMatrixD& weights) {
  const FrameMatrixD clamped = network.left_out().cwiseMax(0.0).cwiseMin(1.0);
  return std::sqrt((clamped - weights).array().square().mean());
}

const ReferencePairs& checked(const PcaModel& pca, const ReferencePairs& pairs) {
  if (pairs.channels.cols() != pca.channel_count() ||
      pairs.channels.rows() != pairs.weights.rows() ||
      pairs.weights.cols() != static_cast<Eigen::Index>(pairs.shapes.size())) {
    throw InternalError({.what = "reference pairs of another layout or face"});
  }
  if (pairs.channels.rows() < kFewestPairs) {
    throw InputError({.what = "there are too few reference pairs for cross-mapping",
                      .expected = "at least " + std::to_string(kFewestPairs),
                      .got = std::to_string(pairs.channels.rows())});
  }
  if ((pairs.channels.rowwise() - pairs.channels.row(0)).squaredNorm() == 0.0) {
    throw InputError(
        {.what = "all reference pairs name the same frame", .expected = "frames that differ"});
  }
  return pairs;
}

std::vector<DimensionTrial> try_dimensions(const PcaModel& pca, const ReferencePairs& pairs,
                                           int most, double sigma) {
  std::vector<DimensionTrial> trials;
  for (int d = 1; d <= std::min(most, kMostTrials); ++d) {
    const RbfNetwork network(project(leading(pca, d), pairs.channels), pairs.weights, sigma);
    trials.push_back({.dimensions = d, .weight_rms = rms_left_out(network, pairs.weights)});
  }
  return trials;
}

int choose_dimensions(const PcaModel& pca, const ReferencePairs& pairs,
                      const CrossMappingOptions& options, std::vector<DimensionTrial>& trials) {
  const auto most = static_cast<int>(
      std::max<Eigen::Index>(1, std::min(pca.dimension_count(), pairs.channels.rows() - 1)));
  if (options.dimensions > 0) {
    return std::min(options.dimensions, most);
  }
  trials = try_dimensions(pca, pairs, most, options.sigma);
  const double least = std::ranges::min(trials, {}, &DimensionTrial::weight_rms).weight_rms;
  return std::ranges::find_if(
             trials,
             [&](const DimensionTrial& trial) { return trial.weight_rms <= kNoBetter * least; })
      ->dimensions;
}

} // namespace

void CrossMappingOptions::validate() const {
  if (dimensions < 0) {
    throw UsageError({.what = "a cross-mapping cannot use that many dimensions",
                      .expected = "a whole number of at least 0 (0 = by cross-validation)",
                      .got = std::to_string(dimensions)});
  }
  if (!(sigma >= 0.0) || !std::isfinite(sigma)) {
    throw UsageError({.what = "the basis functions of a cross-mapping cannot be that wide",
                      .expected = "a number of at least 0 (0 = by generalised cross-validation)",
                      .got = std::to_string(sigma)});
  }
}

CrossMapping::CrossMapping(const PcaModel& pca, const ReferencePairs& pairs,
                           const CrossMappingOptions& options)
    : shapes_(checked(pca, pairs).shapes),
      pca_(leading(pca, choose_dimensions(pca, pairs, options, trials_))),
      network_(project(pca_, pairs.channels), pairs.weights, options.sigma),
      weight_rms_(rms_left_out(network_, pairs.weights)) {}

FrameMatrixD CrossMapping::weights(const FrameMatrixD& channels) const {
  if (channels.cols() != pca_.channel_count()) {
    throw InternalError({.what = "motion of another layout than the cross-mapping's",
                         .expected = std::to_string(pca_.channel_count()),
                         .got = std::to_string(channels.cols())});
  }
  FrameMatrixD result(channels.rows(), static_cast<Eigen::Index>(shapes_.size()));
  for (Eigen::Index first = 0; first < channels.rows(); first += kRowsAtOnce) {
    const Eigen::Index count = std::min(kRowsAtOnce, channels.rows() - first);
    result.middleRows(first, count) =
        network_.at(project(pca_, channels.middleRows(first, count))).cwiseMax(0.0).cwiseMin(1.0);
  }
  for (Eigen::Index k = 0; k < channels.rows(); ++k) {
    if (!channels.row(k).allFinite()) {
      result.row(k) = weights_with_gaps(channels.row(k))
                          .value_or(k > 0 ? Eigen::RowVectorXd(result.row(k - 1))
                                          : Eigen::RowVectorXd::Zero(result.cols()));
    }
  }
  return result;
}

std::optional<Eigen::RowVectorXd>
CrossMapping::weights_with_gaps(const Eigen::RowVectorXd& frame) const {
  std::vector<Eigen::Index> present;
  for (Eigen::Index c = 0; c < frame.size(); ++c) {
    if (std::isfinite(frame(c))) {
      present.push_back(c);
    }
  }
  if (static_cast<Eigen::Index>(present.size()) < 2 * pca_.dimension_count()) {
    return std::nullopt;
  }
  const Eigen::MatrixXd basis = pca_.basis(present, Eigen::all);
  const Eigen::VectorXd offset = frame.transpose()(present) - pca_.mean(present);
  const Eigen::VectorXd coefficients = basis.completeOrthogonalDecomposition().solve(offset);
  return network_.at(coefficients.transpose()).row(0).cwiseMax(0.0).cwiseMin(1.0);
}

} // namespace phonomime
