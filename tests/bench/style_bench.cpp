// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of style, and how fast a model is made: motion as large as a capture's, of a true
// bilinear model with noise.
#include "synth/style/mixture.h"
#include "synth/style/style_model.h"
#include "tests/bench/compare.h"
#include "tests/synth/style/made_speech.h"

#include <cmath>
#include <string>

#include <Eigen/QR>
#include <benchmark/benchmark.h>

namespace phonomime::bench {

namespace {

using test::MadeNumbers;
using test::TrueModel;

constexpr Eigen::Index kDimensions = 25, kChannels = 273, kContents = 20;
constexpr int kSentences = 150, kNodes = 20, kNodeFrames = 9;
const std::vector<std::string> kStyles = {"anger", "happiness", "neutral", "sadness"};

// 150 sentences in each of four emotions: 600, some 100,000 frames.
MotionTable made_speech() {
  MadeNumbers numbers(3);
  MotionTable table;
  for (Eigen::Index marker = 0; marker < kChannels / 3; ++marker) {
    table.layout.groups.push_back({"m" + std::to_string(marker), {Region::lips}});
  }
  table.pca.mean = 30.0 * numbers.matrix(kChannels, 1);
  table.pca.basis =
      Eigen::HouseholderQR<Eigen::MatrixXd>(numbers.matrix(kChannels, kDimensions)).householderQ() *
      Eigen::MatrixXd::Identity(kChannels, kDimensions);
  table.pca.variance = Eigen::VectorXd::LinSpaced(kDimensions, 25.0, 1.0);
  table.rate_hz = 100.0;
  table.phonemes = {{"pau", "pau"}, {"a", "a"}};
  table.visemes = {"pau", "a"};
  table.emotions = kStyles;
  table.speaker = "x";
  const TrueModel truth(kDimensions, 3, kContents, 4, 4);
  const Eigen::Index frames = kSentences * kNodes * kNodeFrames;
  Eigen::MatrixXd contents = test::made_contents(kContents, frames, 5);
  table.coefficients.resize(4 * frames, kDimensions);
  for (Eigen::Index style = 0; style < 4; ++style) {
    table.coefficients.middleRows(style * frames, frames) =
        (truth.shown_all(truth.expressions.col(style), contents) +
         0.1 * numbers.matrix(kDimensions, frames))
            .transpose()
            .cast<float>();
    for (int s = 0; s < kSentences; ++s) {
      const auto sentence = static_cast<std::int32_t>(table.sentences.size());
      table.sentences.push_back(
          {"x", kStyles[static_cast<std::size_t>(style)], "s" + std::to_string(s), ""});
      for (int n = 0; n < kNodes; ++n) {
        MotionNode node{.phoneme = 1, .viseme = 1, .emotion = static_cast<std::int32_t>(style)};
        node.sentence = sentence;
        node.order = n;
        node.first_frame = style * frames + (s * kNodes + n) * kNodeFrames;
        node.frame_count = kNodeFrames;
        table.nodes.push_back(node);
      }
    }
  }
  return table;
}

const MotionTable& speech() {
  static const MotionTable table = made_speech();
  return table;
}

const StyleModel& model() {
  static const StyleModel trained = train_style(speech(), {.content_size = 60,
                                                           .ridge = 0.01,
                                                           .style_size = 3,
                                                           .unknown_content_size = 12,
                                                           .threads = 1})
                                        .model;
  return trained;
}

void style_restyle(benchmark::State& state) {
  const MotionTable& table = speech();
  const StyleModel& trained = model();
  const MotionStyler styler(trained, table.layout, table.pca);
  const Eigen::Index frames = 1000;
  const auto weights = [&](const std::string& emotion, double intensity) -> Eigen::MatrixXd {
    const EmotionModifier part{emotion, intensity};
    return mixture_weights(trained.known.styles, trained.neutral, {&part, 1}).replicate(1, frames);
  };
  const StyleRequest request{.coefficients = table.coefficients.topRows(frames).cast<double>(),
                             .rate_hz = table.rate_hz,
                             .shown = weights("anger", 1.0),
                             .wanted = weights("happiness", 0.7)};
  // T2.10 and T2.11 by hand, for one frame.
  const FrameVectors vectors(table.pca, trained.bundle);
  const auto shown = trained.known.basis(find_style(trained.known.styles, "anger"));
  const Eigen::MatrixXd mixed =
      0.7 * trained.known.basis(find_style(trained.known.styles, "happiness")) +
      0.3 * trained.known.basis(find_style(trained.known.styles, "neutral"));
  const Eigen::VectorXd y = vectors.bundles(request.coefficients).col(500);
  const Eigen::VectorXd& mean = trained.known.mean_content;
  Eigen::MatrixXd ridged = Eigen::MatrixXd::Zero(shown.rows() + shown.cols(), shown.cols());
  ridged.topRows(shown.rows()) = shown;
  ridged.bottomRows(shown.cols()).diagonal().setConstant(std::sqrt(trained.ridge));
  Eigen::VectorXd seen = Eigen::VectorXd::Zero(ridged.rows());
  seen.head(shown.rows()) = y - shown * mean;
  const Eigen::VectorXd content = mean + ridged.householderQr().solve(seen);
  const Eigen::VectorXd expected =
      request.coefficients.row(500).transpose() +
      ((mixed - shown) * content).segment(vectors.middle_row(), kDimensions);
  const double off = (styler.apply(request).coefficients.row(500).transpose() - expected).norm();
  verify(off < 1e-6, "a restyled frame is " + std::to_string(off) + " from the equations'");
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(styler.apply(request));
  }
  state.SetItemsProcessed(state.iterations() * frames); // frames a second
}
BENCHMARK(style_restyle)->Unit(benchmark::kMillisecond);

void style_fit(benchmark::State& state) {
  const MotionTable& table = speech();
  for ([[maybe_unused]] auto _ : state) {
    const TrainedStyle trained = train_style(table, {.threads = 1});
    verify(trained.columns == kSentences * kNodes * kNodeFrames, "not every frame is trained on");
    verify(trained.chosen->best.error < 0.2 * trained.chosen->mean_difference_error,
           "translation is off by " + std::to_string(trained.chosen->best.error) +
               ", the mean difference by " + std::to_string(trained.chosen->mean_difference_error));
  }
}
BENCHMARK(style_fit)->Unit(benchmark::kSecond)->Iterations(1);

} // namespace

} // namespace phonomime::bench
