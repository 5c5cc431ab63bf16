// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/projection.h"

#include <algorithm>
#include <array>
#include <utility>

namespace phonomime::store {
namespace {

// Frames and dimensions of the block of sums that is kept in registers.
constexpr Eigen::Index kTile = 4;
using Tile = Eigen::Array<double, kTile, 1>;

} // namespace

Projection::Projection(const PcaModel& pca) : mean_(pca.mean), dimensions_(pca.dimension_count()) {
  const Eigen::Index padded = (dimensions_ + kTile - 1) / kTile * kTile;
  basis_ = FrameMatrixD::Zero(pca.channel_count(), padded);
  basis_.leftCols(dimensions_) = pca.basis;
}

void Projection::prepare(Job& job, FrameMatrix channels) const {
  job.channels = std::move(channels);
  job.coefficients.resize(job.channels.rows(), dimensions_);
  job.centred = FrameMatrixD::Zero(mean_.size(), kTile);
}

void Projection::run(Job& job) const noexcept {
  const Eigen::Index frame_count = job.channels.rows();
  for (Eigen::Index first = 0; first < frame_count; first += kTile) {
    const Eigen::Index frames = std::min(kTile, frame_count - first);
    for (Eigen::Index frame = 0; frame < frames; ++frame) {
      job.centred.col(frame) = job.channels.row(first + frame).transpose().cast<double>() - mean_;
    }
    for (Eigen::Index dimension = 0; dimension < dimensions_; dimension += kTile) {
      std::array<Tile, kTile> sums;
      sums.fill(Tile::Zero());
      const double* frame_values = job.centred.data();
      const double* basis_values = basis_.data() + dimension;
      for (Eigen::Index channel = 0; channel < mean_.size(); ++channel) {
        const Tile row = Eigen::Map<const Tile>(basis_values);
        for (std::size_t frame = 0; frame < kTile; ++frame) {
          sums[frame] += frame_values[frame] * row;
        }
        frame_values += kTile;
        basis_values += basis_.cols();
      }
      const Eigen::Index dimensions = std::min(kTile, dimensions_ - dimension);
      for (Eigen::Index frame = 0; frame < frames; ++frame) {
        job.coefficients.row(first + frame).segment(dimension, dimensions) =
            sums[static_cast<std::size_t>(frame)].head(dimensions).cast<float>().matrix();
      }
    }
  }
}

} // namespace phonomime::store
