// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/anchors.h"
#include "tools/evaluate/methods.h"
#include "tools/evaluate/node_motion.h"
#include "tools/evaluate/per_emotion.h"

namespace phonomime {

namespace {

// The mean of the frames within the speech.
Eigen::RowVectorXd mean_coefficients(const MotionTable& table, std::int32_t emotion) {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(table.coefficients.cols());
  double count = 0.0;
  for (const TrainingSentence& sentence : training_sentences(table, emotion)) {
    const FrameMatrixD frames =
        table.coefficients.middleRows(sentence.speech.first, sentence.speech.count).cast<double>();
    sum += frames.colwise().sum();
    count += static_cast<double>(frames.rows());
  }
  return sum / count;
}

class MeanPose : public Method {
public:
  explicit MeanPose(const MethodContext& context)
      : table_(context.table), means_(context.table, [&](std::int32_t emotion) {
          return mean_coefficients(context.table, emotion);
        }) {}

  MethodAnswer say(const SentenceRequest& request, std::size_t, const Progress&) override {
    const FrameMatrixD held = means_.of(request).replicate(request.frame_count, 1);
    return {.sentence = {.method = {},
                         .channels = to_channels(table_.pca, held, request.frame_count),
                         .joins = {}}};
  }

private:
  const MotionTable& table_;
  PerEmotion<Eigen::RowVectorXd> means_;
};

} // namespace

std::unique_ptr<Method> make_mean_pose(const MethodContext& context, const Progress&) {
  return std::make_unique<MeanPose>(context);
}

} // namespace phonomime
