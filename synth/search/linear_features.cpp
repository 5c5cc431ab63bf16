// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/linear_features.h"

#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

namespace {

FrameMatrixD padded_transpose(const FrameMatrixD& rows, std::size_t stride) {
  FrameMatrixD result = FrameMatrixD::Zero(rows.cols(), static_cast<Eigen::Index>(stride));
  result.leftCols(rows.rows()) = rows.transpose();
  return result;
}

// The kParts * kDoubleLanes features of project() from weights on; their sums do not wait for each
// other.
template <std::size_t kParts>
inline void project_parts(const double* weights, const float* before, const float* after,
                          std::size_t dimensions, std::size_t stride, float* features) {
  DoubleLanes sums[kParts] = {};
  for (std::size_t k = 0; k < dimensions; ++k) {
    const double start = before == nullptr ? 0.0 : static_cast<double>(before[k]);
    const double change = static_cast<double>(after[k]) - start;
    for (std::size_t part = 0; part < kParts; ++part) {
      DoubleLanes row;
      load(row, weights + k * stride + part * kDoubleLanes);
      sums[part] += row * change;
    }
  }
  for (std::size_t part = 0; part < kParts; ++part) {
    for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
      features[part * kDoubleLanes + lane] = static_cast<float>(sums[part][lane]);
    }
  }
}

// features[f] = float(sum over k of weights[k * stride + f] * (after[k] - before[k])), before = 0
// where it is null; stride a multiple of the number of lanes.
PHONOMIME_DISPATCHED
void project(const double* weights, const float* before, const float* after, std::size_t dimensions,
             std::size_t stride, float* features) {
  constexpr std::size_t kParts = 4;
  std::size_t f = 0;
  for (; f + kParts * kDoubleLanes <= stride; f += kParts * kDoubleLanes) {
    project_parts<kParts>(weights + f, before, after, dimensions, stride, features + f);
  }
  for (; f < stride; f += kDoubleLanes) {
    project_parts<1>(weights + f, before, after, dimensions, stride, features + f);
  }
}

} // namespace

LinearFeatures::LinearFeatures(const MotionTable& table, const FrameMatrixD& pose_rows,
                               const FrameMatrixD& velocity_rows, std::size_t stride)
    : table_(table), stride_((stride + kDoubleLanes - 1) / kDoubleLanes * kDoubleLanes),
      pose_(padded_transpose(pose_rows, stride_)),
      velocity_(padded_transpose(velocity_rows, stride_) * table.rate_hz) {}

void LinearFeatures::fill_first(NodeIndex node, float* features) const {
  const MotionNode& info = table_.nodes[static_cast<std::size_t>(node)];
  const std::int64_t end = info.first_frame + info.frame_count - 1;
  fill_end(features, info.first_frame, info.first_frame, std::min(info.first_frame + 1, end));
}

void LinearFeatures::fill_last(NodeIndex node, float* features) const {
  const MotionNode& info = table_.nodes[static_cast<std::size_t>(node)];
  const std::int64_t end = info.first_frame + info.frame_count - 1;
  fill_end(features, end, std::max(end - 1, info.first_frame), end);
}

void LinearFeatures::fill_end(float* features, std::int64_t edge, std::int64_t before,
                              std::int64_t after) const {
  const auto dimensions = static_cast<std::size_t>(pose_.rows());
  const auto coefficients = [&](std::int64_t frame) {
    return table_.coefficients.row(frame).data();
  };
  project(pose_.data(), nullptr, coefficients(edge), dimensions, stride_, features);
  project(velocity_.data(), coefficients(before), coefficients(after), dimensions, stride_,
          features + stride_);
}

double LinearFeatures::rounding_margin(double alpha3, double largest_frame) const {
  constexpr double kFloatUnit = 0x1p-24;
  const double pose = table_.pca.mean.cwiseAbs().maxCoeff() + largest_frame;
  const double velocity = 2.0 * largest_frame * table_.rate_hz;
  const double exact = (alpha3 * pose + velocity) * table_.layout.channel_count();
  const double features =
      (pose_.colwise().norm().sum() + 2.0 * velocity_.colwise().norm().sum()) * largest_frame;
  return 4.0 * kFloatUnit * (exact + features);
}

double largest_frame_norm(const MotionTable& table) {
  constexpr float kMargin = 1.001f; // sums of squares in single precision
  const std::int64_t frames = table.coefficients.rows();
  float largest = 0.0f;
#pragma omp parallel for schedule(static) reduction(max : largest)
  for (std::int64_t i = 0; i < frames; ++i) {
    largest = std::max(largest, table.coefficients.row(i).squaredNorm());
  }
  return static_cast<double>(std::sqrt(largest) * kMargin);
}

} // namespace phonomime
