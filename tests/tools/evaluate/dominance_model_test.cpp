// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/dominance_model.h"

#include "tests/tools/evaluate/small_table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace phonomime {
namespace {

// A table whose motion a known model makes.
struct MadeByModel {
  MotionTable table;
  DominanceModel model;
  std::vector<TrainingSentence> sentences;
};

MadeByModel make(std::uint64_t seed) {
  test::Draw draw(seed);
  MadeByModel made{.table = test::contextual_table(draw, 60), .model = {}, .sentences = {}};
  MotionTable& table = made.table;
  table.reference_pose = table.pca.mean; // silence is 0 in coefficients
  made.sentences = training_sentences(table, 0);
  const auto visemes = static_cast<Eigen::Index>(table.visemes.size());
  const Eigen::Index dimensions = table.coefficients.cols();
  DominanceModel& model = made.model;
  model.rate_hz = table.rate_hz;
  model.known.assign(table.visemes.size(), true);
  for (FrameMatrixD* part :
       {&model.target, &model.log_height, &model.log_rate[0], &model.log_rate[1]}) {
    part->resize(visemes, dimensions);
    for (double& value : part->reshaped()) {
      value = 0.5 * draw.symmetric();
    }
  }
  model.target *= 20.0;
  model.target.row(0).setZero();
  model.log_rate[0].array() += std::log(15.0);
  model.log_rate[1].array() += std::log(15.0);
  for (const TrainingSentence& sentence : made.sentences) {
    std::vector<Anchor> anchors = sentence.anchors;
    for (Anchor& anchor : anchors) {
      anchor.frame -= static_cast<double>(sentence.speech.first);
    }
    table.coefficients.middleRows(sentence.speech.first, sentence.speech.count) =
        model.evaluate(anchors, sentence.speech.count).cast<float>();
  }
  return made;
}

double squared_error(const MadeByModel& made, const DominanceModel& model) {
  double sum = 0.0;
  for (const TrainingSentence& sentence : made.sentences) {
    std::vector<Anchor> anchors = sentence.anchors;
    for (Anchor& anchor : anchors) {
      anchor.frame -= static_cast<double>(sentence.speech.first);
    }
    sum += (model.evaluate(anchors, sentence.speech.count) -
            made.table.coefficients.middleRows(sentence.speech.first, sentence.speech.count)
                .cast<double>())
               .squaredNorm();
  }
  return sum;
}

double variance(const MadeByModel& made) {
  double sum = 0.0;
  for (const TrainingSentence& sentence : made.sentences) {
    const FrameMatrixD frames =
        made.table.coefficients.middleRows(sentence.speech.first, sentence.speech.count)
            .cast<double>();
    sum += (frames.rowwise() - frames.colwise().mean()).squaredNorm();
  }
  return sum;
}

TEST(DominanceModel, OneSegmentIsItsTargetAndTwoShareByTheirDominance) {
  DominanceModel model;
  model.rate_hz = 100.0;
  model.known = {true, true, false};
  model.target = FrameMatrixD{{0.0}, {8.0}, {100.0}};
  model.log_height = FrameMatrixD{{0.0}, {std::log(2.0)}, {0.0}};
  model.log_rate[0] = FrameMatrixD{{std::log(5.0)}, {std::log(10.0)}, {0.0}};
  model.log_rate[1] = FrameMatrixD{{std::log(20.0)}, {std::log(3.0)}, {0.0}};
  const FrameMatrixD alone = model.evaluate({{1, 10.0}, {2, 12.0}}, 30);
  EXPECT_LT((alone.array() - 8.0).abs().maxCoeff(), 1e-12);
  const FrameMatrixD both = model.evaluate({{0, 4.0}, {1, 16.0}}, 30);
  for (int frame = 0; frame < 30; ++frame) {
    const double a = std::abs(frame - 4.0) / 100.0;
    const double b = std::abs(frame - 16.0) / 100.0;
    const double silence = std::exp(-(frame < 4 ? 5.0 : 20.0) * a);
    const double spoken = 2.0 * std::exp(-(frame < 16 ? 10.0 : 3.0) * b);
    EXPECT_NEAR(both(frame, 0), 8.0 * spoken / (silence + spoken), 1e-12) << frame;
  }
}

TEST(DominanceModel, TheFitFindsTheModelThatMadeTheMotion) {
  const MadeByModel made = make(11);
  const DominanceModel fitted = fit_dominance(made.table, made.sentences, 1, {});
  EXPECT_LT(squared_error(made, made.model), 1e-6 * variance(made)); // the test's own ground
  EXPECT_LT(squared_error(made, fitted), 2e-3 * variance(made));
}

TEST(DominanceModel, NoChangeOfAFittedNumberMakesItBetter) {
  MadeByModel made = make(5);
  test::Draw draw(6);
  for (float& value : made.table.coefficients.reshaped()) {
    value += static_cast<float>(draw.symmetric());
  }
  const DominanceModel fitted = fit_dominance(made.table, made.sentences, 1, {});
  const double error = squared_error(made, fitted);
  EXPECT_LT(error, 0.5 * variance(made));
  for (FrameMatrixD DominanceModel::*part :
       {&DominanceModel::target, &DominanceModel::log_height}) {
    for (Eigen::Index viseme = 0; viseme < fitted.target.rows(); ++viseme) {
      for (const double step : {-0.2, 0.2}) {
        DominanceModel moved = fitted;
        (moved.*part)(viseme, 0) += step;
        EXPECT_GT(squared_error(made, moved), error * (1.0 - 1e-4)) << viseme << " " << step;
      }
    }
  }
}

TEST(DominanceModel, IsTheSameWithOneThreadAndTwo) {
  const MadeByModel made = make(2);
  const DominanceModel one = fit_dominance(made.table, made.sentences, 1, {});
  const DominanceModel two = fit_dominance(made.table, made.sentences, 2, {});
  EXPECT_EQ(one.target, two.target);
  EXPECT_EQ(one.log_height, two.log_height);
  EXPECT_EQ(one.log_rate[0], two.log_rate[0]);
  EXPECT_EQ(one.log_rate[1], two.log_rate[1]);
}

} // namespace
} // namespace phonomime
