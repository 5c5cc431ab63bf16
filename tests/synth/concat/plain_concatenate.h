// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/concat/concatenate.h"

#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Dense>

namespace phonomime::test {

// DESIGN section 5 written down as plainly as it reads, for steps that are all a whole number of
// frames of 1 / rate long: the judge of concatenate(). Frames are asked one by one what they are,
// splines come from the dense K = Q R^-1 Q^T.
class PlainConcatenation {
public:
  PlainConcatenation(const MotionTable& table, std::span<const ConcatStep> steps,
                     const ConcatOptions& options)
      : table_(table), steps_(steps), options_(options) {
    for (const ConcatStep& step : steps) {
      bounds_.push_back(std::llround(step.start_s * table.rate_hz));
    }
    bounds_.push_back(std::llround(steps.back().end_s * table.rate_hz));
  }

  FrameMatrixD run() {
    const Eigen::Index end = bounds_.back();
    frames_ = FrameMatrixD::Zero(end + 1, table_.coefficients.cols());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      for (Eigen::Index k = bounds_[i]; shown(i) && k < bounds_[i + 1]; ++k) {
        frames_.row(k) = warped(steps_[i].node, k - bounds_[i], bounds_[i + 1] - bounds_[i]);
      }
    }
    for (std::size_t i = 1; i < steps_.size(); ++i) {
      if (shown(i - 1) && shown(i) && !steps_[i].captured) {
        smooth(i);
      }
    }
    if (shown(steps_.size() - 1)) {
      frames_.row(end) = frames_.row(end - 1);
    }
    const FrameMatrixD speech = frames_;
    for (Eigen::Index k = 0; k <= end; ++k) {
      if (!spoken(k)) {
        frames_.row(k) = silent(speech, k);
      }
    }
    return frames_;
  }

private:
  using Row = Eigen::RowVectorXd;

  bool shown(std::size_t step) const { return !steps_[step].is_silence || steps_[step].show_node; }

  bool spoken(Eigen::Index k) const {
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const bool last = i + 1 == steps_.size();
      if (bounds_[i] <= k && (k < bounds_[i + 1] || (last && k == bounds_[i + 1]))) {
        return shown(i);
      }
    }
    return false;
  }

  Row warped(NodeIndex node, Eigen::Index i, Eigen::Index m) const {
    const FrameMatrixD source = table_.node_frames(node).cast<double>();
    const double n = static_cast<double>(source.rows());
    const double u =
        m == 1 ? (n - 1) / 2 : static_cast<double>(i) * (n - 1) / static_cast<double>(m - 1);
    const auto before = static_cast<Eigen::Index>(std::floor(u + 1e-9));
    const Eigen::Index after = std::min(before + 1, source.rows() - 1);
    const double share = u - static_cast<double>(before);
    return (1.0 - share) * source.row(before) + share * source.row(after);
  }

  double weight(std::size_t step) const {
    const MotionNode& node = table_.nodes[static_cast<std::size_t>(steps_[step].node)];
    const std::map<std::string, double> classes = {{"p", 2.0}, {"ae", 1.0}, {"k", 0.5}};
    return classes.at(table_.phonemes[static_cast<std::size_t>(node.phoneme)].name);
  }

  void smooth(std::size_t step) {
    const Eigen::Index half = options_.smoothing_half_window;
    const Eigen::Index left = std::min(half, bounds_[step] - bounds_[step - 1]);
    const Eigen::Index right = std::min(half, bounds_[step + 1] - bounds_[step]);
    const Eigen::Index n = left + right;
    if (n < 3) {
      return;
    }
    Eigen::MatrixXd q = Eigen::MatrixXd::Zero(n, n - 2);
    Eigen::MatrixXd r = Eigen::MatrixXd::Zero(n - 2, n - 2);
    for (Eigen::Index j = 0; j < n - 2; ++j) {
      q.block<3, 1>(j, j) << 1.0, -2.0, 1.0;
      r(j, j) = 2.0 / 3.0;
      if (j > 0) {
        r(j, j - 1) = r(j - 1, j) = 1.0 / 6.0;
      }
    }
    Eigen::VectorXd weights(n);
    weights << Eigen::VectorXd::Constant(left, weight(step - 1)),
        Eigen::VectorXd::Constant(right, weight(step));
    const Eigen::MatrixXd w = weights.asDiagonal();
    auto window = frames_.middleRows(bounds_[step] - left, n);
    const Eigen::MatrixXd f = window;
    window = (w + q * r.inverse() * q.transpose()).fullPivLu().solve(w * f);
  }

  double shape(double x) const {
    switch (options_.silence.fill) {
    case SilenceFill::linear:
      return x;
    case SilenceFill::cosine:
      return 0.5 * (1.0 - std::cos(std::numbers::pi * x));
    case SilenceFill::cubic:
      return 3.0 * x * x - 2.0 * x * x * x;
    }
    return 0.0;
  }

  // What the velocity of border `at` adds `distance` frames into a silence that it may fill up to
  // `room` frames deep; `inward` points from the border into the speech.
  Row carried(const FrameMatrixD& speech, Eigen::Index at, Eigen::Index inward, double distance,
              double room) const {
    const double reach = std::min(room, 0.2 * table_.rate_hz);
    const Eigen::Index inner = at + inward;
    if (options_.silence.fill != SilenceFill::cubic || inner < 0 || inner >= speech.rows() ||
        !spoken(inner) || distance >= reach) {
      return Row::Zero(speech.cols());
    }
    const double x = distance / reach;
    return (x * x * x - 2.0 * x * x + x) * reach * (speech.row(at) - speech.row(inner));
  }

  Row silent(const FrameMatrixD& speech, Eigen::Index k) const {
    Eigen::Index left = k;
    while (left >= 0 && !spoken(left)) {
      --left;
    }
    Eigen::Index right = k;
    while (right < speech.rows() && !spoken(right)) {
      ++right;
    }
    const bool has_left = left >= 0;
    const bool has_right = right < speech.rows();
    const Row rest = table_.pca.project(table_.reference_pose).transpose();
    if (!has_left && !has_right) {
      return rest;
    }
    const auto length = static_cast<double>(right - left);
    if (has_left && has_right) {
      const auto from_left = static_cast<double>(k - left);
      return speech.row(left) + shape(from_left / length) * (speech.row(right) - speech.row(left)) +
             carried(speech, left, -1, from_left, length) +
             carried(speech, right, +1, length - from_left, length);
    }
    const Eigen::Index border = has_left ? left : right;
    if (!options_.silence.rest_at_ends) {
      return speech.row(border);
    }
    const double within = options_.silence.rest_within_s * table_.rate_hz;
    const double time = std::min(within, std::max(length - 1.0, within / 2.0));
    const auto distance = static_cast<double>(std::abs(k - border));
    if (distance >= time) {
      return rest;
    }
    return speech.row(border) + shape(distance / time) * (rest - speech.row(border)) +
           carried(speech, border, has_left ? -1 : +1, distance, time);
  }

  const MotionTable& table_;
  std::span<const ConcatStep> steps_;
  const ConcatOptions& options_;
  std::vector<Eigen::Index> bounds_; // #steps + 1, in frames
  FrameMatrixD frames_;
};

inline FrameMatrixD plain_concatenate(const MotionTable& table, std::span<const ConcatStep> steps,
                                      const ConcatOptions& options) {
  return PlainConcatenation(table, steps, options).run();
}

} // namespace phonomime::test
