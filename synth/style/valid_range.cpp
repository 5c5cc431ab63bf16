// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/valid_range.h"

#include "synth/style/mixture.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

namespace {

// Squared distances from the mean, in standard deviations: one a frame.
Eigen::VectorXd strangeness(const FrameMatrixD& frames, const Eigen::VectorXd& variance) {
  const Eigen::VectorXd weights =
      variance.unaryExpr([](double value) { return value > 0.0 ? 1.0 / value : 0.0; });
  return frames.cwiseAbs2() * weights;
}

FrameMatrixD frames_of(const MotionTable& table, std::span<const std::string> emotions) {
  Eigen::Index count = 0;
  std::vector<const MotionNode*> nodes;
  for (const MotionNode& node : table.nodes) {
    const std::string& emotion = table.emotions[static_cast<std::size_t>(node.emotion)];
    if (std::ranges::find(emotions, emotion) != emotions.end()) {
      nodes.push_back(&node);
      count += node.frame_count;
    }
  }
  FrameMatrixD frames(count, table.coefficients.cols());
  Eigen::Index first = 0;
  for (const MotionNode* node : nodes) {
    frames.middleRows(first, node->frame_count) =
        table.coefficients.middleRows(node->first_frame, node->frame_count).cast<double>();
    first += node->frame_count;
  }
  return frames;
}

} // namespace

std::vector<ValidRange> valid_ranges(const MotionTable& table, const Restyler& restyler,
                                     const std::vector<std::string>& styles,
                                     const std::string& neutral) {
  Eigen::VectorXd recorded = strangeness(frames_of(table, styles), table.pca.variance);
  std::ranges::sort(recorded);
  const auto last = static_cast<double>(recorded.size() - 1);
  const double limit = recorded[static_cast<Eigen::Index>(std::floor(kRecordedShare * last))];
  const FrameMatrixD frames = frames_of(table, {&neutral, 1});
  const Eigen::MatrixXd shown = mixture_weights(styles, neutral, {}).replicate(1, frames.rows());
  std::vector<ValidRange> ranges;
  for (const std::string& style : styles) {
    if (style == neutral) {
      continue;
    }
    ValidRange range{.emotion = style};
    // What a style adds is linear in its intensity: once is enough.
    const EmotionModifier whole{style, 1.0};
    const FrameMatrixD added =
        restyler.restyle(
            frames, shown,
            mixture_weights(styles, neutral, {&whole, 1}).replicate(1, frames.rows())) -
        frames;
    for (int step = 1; step * kIntensityStep <= kIntensityEnd + 1e-9; ++step) {
      const Eigen::VectorXd found =
          strangeness(frames + step * kIntensityStep * added, table.pca.variance);
      const auto strange = static_cast<double>((found.array() > limit).count());
      if (strange > kStrangeShare * static_cast<double>(found.size())) {
        break;
      }
      range.largest_intensity = step * kIntensityStep;
    }
    ranges.push_back(range);
  }
  return ranges;
}

} // namespace phonomime
