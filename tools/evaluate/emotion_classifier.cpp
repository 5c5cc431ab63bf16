// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/emotion_classifier.h"

#include "db/types/errors.h"

#include <algorithm>
#include <map>
#include <utility>

namespace phonomime {

EmotionClassifier::EmotionClassifier(const MotionTable& table, EmotionFeatures kind)
    : table_(table), kind_(kind) {
  // First and end frame of each sentence.
  std::map<std::int32_t, std::pair<std::int64_t, std::int64_t>> spans;
  std::map<std::int32_t, std::int32_t> emotion_of;
  for (const MotionNode& node : table.nodes) {
    const std::int64_t end = node.first_frame + node.frame_count;
    const auto [span, is_new] = spans.try_emplace(node.sentence, node.first_frame, end);
    span->second = {std::min(span->second.first, node.first_frame),
                    std::max(span->second.second, end)};
    emotion_of[node.sentence] = node.emotion;
  }
  std::map<std::int32_t, std::vector<Eigen::VectorXd>> examples;
  for (const auto& [sentence, span] : spans) {
    const FrameMatrixD frames =
        table.coefficients.middleRows(span.first, span.second - span.first).cast<double>();
    examples[emotion_of[sentence]].push_back(features(frames));
  }
  if (examples.size() < 2) {
    throw InputError({.where = "speaker " + table.speaker,
                      .what = "all recordings are of one emotion",
                      .expected = "recordings in several emotions to tell apart"});
  }
  const auto count = static_cast<Eigen::Index>(examples.size());
  centroids_.resize(examples.begin()->second.front().size(), count);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(centroids_.rows());
  for (const auto& [emotion, some] : examples) {
    const auto column = static_cast<Eigen::Index>(emotions_.size());
    emotions_.push_back(emotion);
    centroids_.col(column).setZero();
    for (const Eigen::VectorXd& one : some) {
      centroids_.col(column) += one / static_cast<double>(some.size());
    }
    for (const Eigen::VectorXd& one : some) {
      squares += (one - centroids_.col(column)).cwiseAbs2();
    }
  }
  // A feature that never varies within an emotion tells nothing of how far off a sentence is.
  deviations_ = (squares / static_cast<double>(spans.size())).cwiseSqrt();
  deviations_ = (deviations_.array() > 1e-12).select(deviations_, 1.0);
  centroids_ = deviations_.cwiseInverse().asDiagonal() * centroids_;
}

std::int32_t EmotionClassifier::recognise(const Eigen::Ref<const FrameMatrix>& channels) const {
  const FrameMatrixD coefficients =
      (channels.cast<double>().rowwise() - table_.pca.mean.transpose()) * table_.pca.basis;
  const Eigen::VectorXd sentence = features(coefficients).cwiseQuotient(deviations_);
  Eigen::Index nearest = 0;
  (centroids_.colwise() - sentence).colwise().squaredNorm().minCoeff(&nearest);
  return emotions_[static_cast<std::size_t>(nearest)];
}

Eigen::VectorXd
EmotionClassifier::features(const Eigen::Ref<const FrameMatrixD>& coefficients) const {
  const Eigen::RowVectorXd mean = coefficients.colwise().mean();
  if (kind_ == EmotionFeatures::pose) {
    return mean.transpose();
  }
  const Eigen::RowVectorXd variance = (coefficients.rowwise() - mean).cwiseAbs2().colwise().mean();
  Eigen::VectorXd both(2 * coefficients.cols());
  both << mean.transpose(), variance.cwiseSqrt().transpose();
  return both;
}

} // namespace phonomime
