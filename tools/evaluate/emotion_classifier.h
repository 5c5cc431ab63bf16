// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"

#include <cstdint>
#include <vector>

namespace phonomime {

// What a sentence is to the classifier: how the face stands, the mean over its frames of each PCA
// coefficient; or that and how much it moves, their standard deviations.
enum class EmotionFeatures { pose, pose_and_movement };

// Tells a sentence's emotion from its motion: the nearest of the emotions' centroids, each the mean
// of the recorded sentences of one emotion, each feature divided by its standard deviation within
// the emotions.
class EmotionClassifier {
public:
  // Fitted to the sentences of `table`, from the first node of each to its last. `table` must
  // outlive it. Throws InputError where it has recordings of fewer than two emotions.
  EmotionClassifier(const MotionTable& table, EmotionFeatures features);

  // Of frames as channels (#frames by #channels, within the speech), an index into
  // MotionTable::emotions; of emotions at the same distance the first.
  std::int32_t recognise(const Eigen::Ref<const FrameMatrix>& channels) const;

private:
  Eigen::VectorXd features(const Eigen::Ref<const FrameMatrixD>& coefficients) const;

  const MotionTable& table_;
  EmotionFeatures kind_;
  Eigen::VectorXd deviations_;         // #features, within the emotions
  std::vector<std::int32_t> emotions_; // #centroids
  Eigen::MatrixXd centroids_;          // #features by #centroids, over deviations_
};

} // namespace phonomime
