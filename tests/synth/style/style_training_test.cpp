// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/style_training.h"

#include "db/types/progress.h"
#include "synth/style/align_phonemes.h"
#include "synth/style/mixture.h"
#include "synth/style/style_model.h"
#include "tests/support/expect_error.h"
#include "tests/synth/style/made_table.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime::test {

namespace {

std::size_t edit_distance(std::span<const std::int32_t> a, std::span<const std::int32_t> b) {
  if (a.empty() || b.empty()) {
    return a.size() + b.size();
  }
  const std::size_t last =
      edit_distance(a.first(a.size() - 1), b.first(b.size() - 1)) + (a.back() == b.back() ? 0 : 1);
  return std::min({last, edit_distance(a.first(a.size() - 1), b) + 1,
                   edit_distance(a, b.first(b.size() - 1)) + 1});
}

// Eight sentences, neutral and joyful.
MadeTable made_speaker() {
  MadeTable made;
  for (int i = 0; i < 8; ++i) {
    const std::string id = "s" + std::to_string(i);
    made.say(id, "neutral", {{"a", 9 + i}, {"b", 12}, {"c", 8}});
    made.say(id, "joy", {{"a", 11}, {"b", 9 + i}, {"c", 7}});
  }
  made.table.layout.groups = {{"chin", {Region::jaw}}, {"lip", {Region::lips}}};
  made.table.pca.variance = Eigen::Vector2d(100.0, 1.0);
  return made;
}

} // namespace

TEST(FrameVectors, LieAsTheChannelsLie) {
  const PcaModel pca = made_pca();
  const FrameVectors vectors(pca, 1);
  const Eigen::Vector2d first(0.3, -2.0), second(1.5, 0.25);
  Eigen::VectorXd a(3), b(3);
  vectors.write_frame(first, a);
  vectors.write_frame(second, b);
  const Eigen::VectorXd x = pca.reconstruct(first), y = pca.reconstruct(second);
  EXPECT_NEAR(a.norm(), x.norm(), 1e-12);
  EXPECT_NEAR((a - b).norm(), (x - y).norm(), 1e-12);
  EXPECT_NEAR(a.dot(b), x.dot(y), 1e-11);
}

TEST(FrameVectors, OfCoefficientsLieAsTheseLieWithTheMeanApart) {
  const PcaModel pca = made_pca();
  const FrameVectors vectors(pca, 1, StyleVectors::coefficients);
  const Eigen::Vector2d first(0.3, -2.0), second(1.5, 0.25);
  Eigen::VectorXd a(3), b(3);
  vectors.write_frame(first, a);
  vectors.write_frame(second, b);
  EXPECT_EQ(a.head(2), first);
  EXPECT_NEAR((a - b).norm(), (first - second).norm(), 1e-12);
  EXPECT_NEAR(a.dot(b), first.dot(second) + pca.mean.squaredNorm(), 1e-11);
  EXPECT_LT((vectors.coefficients(a) - first.transpose()).norm(), 1e-13);
}

TEST(FrameVectors, BundleNeighboursAndGiveTheMiddleBack) {
  const FrameVectors vectors(made_pca(), 3);
  const FrameMatrixD frames = MadeNumbers(9).matrix(5, 2);
  const Eigen::MatrixXd bundles = vectors.bundles(frames);
  ASSERT_EQ(bundles.rows(), 9);
  Eigen::VectorXd vector(3);
  for (Eigen::Index t = 0; t < 5; ++t) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Eigen::Index frame = std::max<Eigen::Index>(0, std::min<Eigen::Index>(4, t + k - 1));
      vectors.write_frame(frames.row(frame).transpose(), vector);
      EXPECT_EQ(bundles.col(t).segment(3 * k, 3), vector);
    }
  }
  const FrameMatrixD back =
      vectors.coefficients(bundles.middleRows(vectors.middle_row(), vectors.frame_size()));
  EXPECT_LT((back - frames).norm(), 1e-13);
  expect_error([] { FrameVectors(made_pca(), 2); }, "has no middle (expected an odd number");
}

TEST(AlignPhonemes, PairsEqualPhonemesAtLeastEditDistance) {
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  const std::vector<std::int32_t> word = {1, 2, 3, 4}, other = {1, 5, 3, 3, 4};
  EXPECT_EQ(align_phonemes(word, word), (Pairs{{0, 0}, {1, 1}, {2, 2}, {3, 3}}));
  EXPECT_EQ(align_phonemes(word, other), (Pairs{{0, 0}, {2, 3}, {3, 4}}));
  EXPECT_EQ(align_phonemes(word, {}), Pairs{});
  MadeNumbers numbers(4);
  for (int round = 0; round < 60; ++round) {
    const auto draw = [&] {
      std::vector<std::int32_t> made(static_cast<std::size_t>(3.5 * (numbers.next() + 1.0)));
      for (std::int32_t& phoneme : made) {
        phoneme = static_cast<std::int32_t>(1.5 * (numbers.next() + 1.0));
      }
      return made;
    };
    const std::vector<std::int32_t> a = draw(), b = draw();
    const Pairs pairs = align_phonemes(a, b);
    // Between two pairs, exchanges and then insertions or deletions make up the rest.
    std::size_t cost = 0, i = 0, j = 0;
    for (std::size_t p = 0; p <= pairs.size(); ++p) {
      const auto [to_i, to_j] =
          p < pairs.size() ? pairs[p] : std::pair<std::size_t, std::size_t>{a.size(), b.size()};
      ASSERT_LE(i, to_i);
      ASSERT_LE(j, to_j);
      cost += std::max(to_i - i, to_j - j);
      if (p < pairs.size()) {
        EXPECT_EQ(a[to_i], b[to_j]);
        i = to_i + 1, j = to_j + 1;
      }
    }
    EXPECT_EQ(cost, edit_distance(a, b));
  }
}

TEST(StyleTraining, AlignsLinearlyInsidePhonemesAtTheStylesOwnTempo) {
  MadeTable made;
  made.say("s1", "anger", {{"a", 7}, {"b", 1}, {"c", 3}});
  made.say("s1", "neutral", {{"a", 4}, {"b", 3}, {"c", 1}});
  const FrameVectors vectors(made.table.pca, 3);
  const StyleTraining training = gather_styles(made.table, vectors, {.parts = 1});
  EXPECT_EQ(training.styles, (std::vector<std::string>{"neutral", "anger"}));
  EXPECT_EQ(training.nodes, 3);
  EXPECT_TRUE(training.not_aligned.empty());
  ASSERT_EQ(training.parts.size(), 1U);
  const StyleStack& stack = training.parts[0];
  ASSERT_EQ(stack.columns.cols(), 8); // the reference's frames
  const auto frame = [&](Eigen::Index style, Eigen::Index place, Eigen::Index column) {
    return vectors.coefficients(stack.columns.col(column).segment(9 * style + 3 * place, 3));
  };
  for (Eigen::Index t = 0; t < 8; ++t) {
    EXPECT_NEAR(frame(0, 1, t)(0, 1), 1.0, 1e-12); // neutral is emotion 1
    EXPECT_NEAR(frame(1, 1, t)(0, 1), 0.0, 1e-12);
  }
  for (Eigen::Index t = 0; t < 4; ++t) { // a: 4 frames onto 7
    EXPECT_NEAR(frame(0, 1, t)(0, 0), 10.0 + static_cast<double>(t) / 3.0, 1e-6);
    EXPECT_NEAR(frame(1, 1, t)(0, 0), 10.0 + static_cast<double>(t) / 3.0, 1e-6);
  }
  // A sixth of the way is a frame in anger, a third in neutral.
  EXPECT_NEAR(frame(1, 2, 1)(0, 0), 10.0 + 3.0 / 6.0, 1e-6);
  EXPECT_NEAR(frame(0, 2, 1)(0, 0), 10.0 + 2.0 / 3.0, 1e-6);
  EXPECT_NEAR(frame(1, 0, 1)(0, 0), 10.0 + 1.0 / 6.0, 1e-6);
  EXPECT_NEAR(frame(1, 0, 0)(0, 0), 10.0, 1e-6);       // repeated at the start
  EXPECT_NEAR(frame(1, 1, 5)(0, 0), 20.5, 1e-6);       // b: the one frame
  EXPECT_NEAR(frame(1, 1, 7)(0, 0), 30.0 + 0.5, 1e-6); // c: the middle, for a reference of one
}

TEST(StyleTraining, SaysWhatItCouldNotAlign) {
  MadeTable made;
  made.say("s1", "anger", {{"a", 3}, {"c", 2}});
  made.say("s1", "neutral", {{"a", 3}, {"b", 4}, {"c", 2}});
  made.say("s2", "neutral", {{"a", 3}});
  made.say("s3", "anger", {{"b", 3}});
  made.say("s3", "neutral", {{"b", 2}});
  const StyleTraining training =
      gather_styles(made.table, FrameVectors(made.table.pca, 3), {.parts = 5});
  EXPECT_EQ(training.sentences, (std::vector<std::string>{"s1", "s3"}));
  EXPECT_EQ(training.nodes, 3);
  EXPECT_EQ(training.nodes_left_out, 1);
  ASSERT_EQ(training.not_aligned.size(), 2U);
  EXPECT_EQ(training.not_aligned[0].reason, "1 of its 3 phonemes are not said in every style");
  EXPECT_EQ(training.not_aligned[1].sentence, "s2");
  EXPECT_EQ(training.not_aligned[1].reason, "there is no recording of it in anger");
  ASSERT_EQ(training.parts.size(), 2U); // as many as there are sentences
  EXPECT_EQ(training.parts[0].columns.cols(), 5);
  EXPECT_EQ(training.parts[1].columns.cols(), 2);
}

TEST(StyleTraining, RefusesWhatIsNotThere) {
  MadeTable made;
  made.say("s1", "anger", {{"a", 3}});
  const FrameVectors vectors(made.table.pca, 3);
  expect_error(
      [&] {
        gather_styles(made.table, vectors, {.styles = {"neutral", "boredom"}});
      },
      "no recording of the emotion boredom (expected anger, neutral, joy)");
  expect_error([&] { gather_styles(made.table, vectors, {}); },
               "the neutral style is none of the styles (expected anger, got neutral)");
  expect_error([&] { gather_styles(made.table, vectors, {.reference = "anger"}); },
               "several styles (expected at least 2, got anger)");
  expect_error(
      [&] {
        gather_styles(made.table, vectors, {.styles = {"anger", "neutral"}});
      },
      "no speech that was recorded in every style");
}

TEST(TrainStyle, TellsItsStagesAndStopsInEach) {
  const MadeTable made = made_speaker();
  const StyleOptions options{.training = {.parts = 4}, .bundle = 1, .threads = 2};
  std::vector<std::string> stages;
  Progress progress;
  progress.report = [&](std::string_view stage, std::int64_t, std::int64_t) {
    if (stages.empty() || stages.back() != stage) {
      stages.emplace_back(stage);
    }
  };
  train_style(made.table, options, progress);
  ASSERT_EQ(stages, (std::vector<std::string>{"aligning sentences", "choosing dimensions",
                                              "finding emotions", "fitting"}));
  for (const std::string& last : stages) {
    std::atomic<bool> stop = false;
    std::string told;
    const Progress stopping{.report = [&](std::string_view stage, std::int64_t,
                                          std::int64_t) { stop = (told = stage) == last; },
                            .stop = &stop};
    EXPECT_THROW(train_style(made.table, options, stopping), Interrupted);
    EXPECT_EQ(told, last);
  }
}

TEST(ValidRange, EndsWhereATwentiethOfTheFacesIsStrange) {
  const MadeTable made = made_speaker();
  const MotionTable& table = made.table;
  const StyleModel model =
      train_style(table, {.bundle = 1, .content_size = 2, .ridge = 0.01, .threads = 1}).model;
  const auto strangeness = [](const Eigen::Vector2d& frame) {
    return frame[0] * frame[0] / 100.0 + frame[1] * frame[1];
  };
  std::vector<double> recorded;
  std::vector<Eigen::Vector2d> neutral;
  for (NodeIndex n = 0; n < table.node_count(); ++n) {
    const FrameMatrixD frames = table.node_frames(n).cast<double>();
    for (Eigen::Index t = 0; t < frames.rows(); ++t) {
      recorded.push_back(strangeness(frames.row(t)));
      if (table.nodes[static_cast<std::size_t>(n)].emotion == *table.find_emotion("neutral")) {
        neutral.emplace_back(frames.row(t));
      }
    }
  }
  std::ranges::sort(recorded);
  const double limit = recorded[(recorded.size() - 1) * 99 / 100];
  StyleRequest request{.coefficients = FrameMatrixD(neutral.size(), 2), .rate_hz = 100.0};
  for (std::size_t t = 0; t < neutral.size(); ++t) {
    request.coefficients.row(static_cast<Eigen::Index>(t)) = neutral[t].transpose();
  }
  const Eigen::Index count = request.coefficients.rows();
  request.shown = mixture_weights(model.known.styles, "neutral", {}).replicate(1, count);
  ASSERT_EQ(model.valid.size(), 1U);
  const auto share_of_strange = [&](double intensity) {
    const EmotionModifier joy{"joy", intensity};
    request.wanted = mixture_weights(model.known.styles, "neutral", {&joy, 1}).replicate(1, count);
    const FrameMatrixD shown = apply_style(model, table.layout, table.pca, request).coefficients;
    double strange = 0.0;
    for (Eigen::Index t = 0; t < count; ++t) {
      strange += strangeness(shown.row(t)) > limit ? 1.0 : 0.0;
    }
    return strange / static_cast<double>(count);
  };
  const double last = model.valid.front().largest_intensity;
  EXPECT_GT(last, 0.5);
  EXPECT_LT(last, 2.5);
  EXPECT_LE(share_of_strange(last - 1e-6), 0.05);
  EXPECT_GT(share_of_strange(last + kIntensityStep + 1e-6), 0.05);
  EXPECT_EQ(apply_style(model, table.layout, table.pca, request).warnings.size(), 1U);
  share_of_strange(last);
  EXPECT_TRUE(apply_style(model, table.layout, table.pca, request).warnings.empty());
}

TEST(MotionStyler, ChangesAnotherFaceAsTheModelsOwn) {
  const MadeTable made = made_speaker();
  const MotionTable& table = made.table;
  StyleModel model =
      train_style(table, {.bundle = 1, .content_size = 2, .ridge = 0.01, .threads = 1}).model;
  const Eigen::Vector2d away(3.0, -2.0);
  StyleRequest request{.coefficients = table.coefficients.topRows(20).cast<double>(),
                       .rate_hz = 100.0};
  request.shown = mixture_weights(model.known.styles, "neutral", {}).replicate(1, 20);
  const EmotionModifier joy{"joy", 1.0};
  request.wanted = mixture_weights(model.known.styles, "neutral", {&joy, 1}).replicate(1, 20);
  const auto change = [&] {
    return FrameMatrixD(apply_style(model, table.layout, table.pca, request).coefficients -
                        request.coefficients);
  };
  const FrameMatrixD own = change();
  request.coefficients.rowwise() -= away.transpose();
  EXPECT_GT((change() - own).norm(), 0.01 * own.norm());
  model.to_own_face = away;
  EXPECT_LT((change() - own).norm(), 1e-9 * own.norm());
  request.wanted = request.shown;
  EXPECT_EQ(change().norm(), 0.0);
}

} // namespace phonomime::test
