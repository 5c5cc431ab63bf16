// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tune/tuning.h"

#include "db/types/json_file.h"
#include "synth/search/cost_weights.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace phonomime {
namespace {

// Two folds of four sentences each; on the held-out ones `gain` less of the error, every time.
Tuning made_tuning(double gain) {
  Tuning tuning;
  tuning.corpus = "a & b";
  tuning.options = {{"seed", "1"}};
  tuning.weights = {tunable_weights().begin(), tunable_weights().begin() + 2};
  tuning.shipped.alpha1 = tuning.shipped.alpha4 = 0.5;
  tuning.shipped.alpha2 = 0.2;
  const auto part = [&](int fold) {
    TunedPart made{.fold = fold, .tuned = tuning.shipped};
    made.tuned.alpha2 = 0.31;
    made.looks = {{tuning.shipped, 2.0}, {made.tuned, 1.5}};
    for (int i = 0; i < 4; ++i) {
      const double error = 2.0 + 0.1 * i + 0.01 * fold;
      made.inner.keys.push_back("s/neutral/inner" + std::to_string(i));
      made.inner.shipped.push_back(error);
      made.inner.tuned.push_back(error - 0.5);
      if (fold > 0) {
        made.held_out.keys.push_back("s/neutral/outer" + std::to_string(i));
        made.held_out.shipped.push_back(error);
        made.held_out.tuned.push_back(error - gain * (1.0 + 0.1 * i + 0.05 * fold));
      }
    }
    return made;
  };
  tuning.folds = {part(1), part(2)};
  tuning.all = part(0);
  return tuning;
}

TEST(Tuning, TellsGainsByHand) {
  const Scores scores{.keys = {"a", "b", "c", "d"},
                      .shipped = {3.0, 2.0, std::nullopt, 4.0},
                      .tuned = {2.0, 2.5, 1.0, 2.0}};
  const Gain gain = gain_of(scores, Measure::squared_error);
  EXPECT_EQ(gain.sentences, 3);
  EXPECT_DOUBLE_EQ(*gain.shipped, 3.0);
  EXPECT_DOUBLE_EQ(*gain.tuned, 6.5 / 3.0);
  EXPECT_DOUBLE_EQ(*gain.gain, (1.0 - 0.5 + 2.0) / 3.0);
  // Differences 1, -0.5, 2 around their mean 5/6.
  const double square = (1.0 / 36.0 + 64.0 / 36.0 + 49.0 / 36.0) / 2.0;
  EXPECT_NEAR(*gain.standard_error, std::sqrt(square / 3.0), 1e-12);
  EXPECT_EQ(gain.better, 2);
  EXPECT_EQ(gain.worse, 1);
  EXPECT_NEAR(gain.p_value, 0.5, 1e-12); // ranks 2, -1, 3: 4 of 8 signs are as far
}

TEST(Tuning, OfACorrelationMoreIsBetter) {
  const Scores scores{.keys = {"a"}, .shipped = {0.8}, .tuned = {0.9}};
  const Gain gain = gain_of(scores, Measure::aperture_correlation);
  EXPECT_NEAR(*gain.gain, 0.1, 1e-12);
  EXPECT_EQ(gain.better, 1);
}

TEST(Tuning, OfARatioNearOneIsBetter) {
  const Scores scores{.keys = {"a"}, .shipped = {0.8}, .tuned = {1.1}};
  EXPECT_NEAR(*gain_of(scores, Measure::aperture_deviation_ratio).gain, 0.1, 1e-12);
}

TEST(Tuning, JudgesByHeldOutSentencesAlone) {
  EXPECT_EQ(verdict_of(made_tuning(0.2)), TuningVerdict::better);
  EXPECT_EQ(verdict_of(made_tuning(-0.2)), TuningVerdict::worse);
  EXPECT_EQ(verdict_of(made_tuning(0.0)), TuningVerdict::no_difference);
}

TEST(Tuning, ReportsAreWhatTheirFormatSays) {
  const Tuning tuning = made_tuning(0.2);
  const nlohmann::json json = parse_json_as("tuning", tuning_json(tuning), "report");
  EXPECT_EQ(json.at("verdict"), "better");
  EXPECT_EQ(json.at("held_out").at("sentences"), 8);
  EXPECT_DOUBLE_EQ(json.at("inner").at("gain"), 0.5);
  EXPECT_EQ(json.at("folds").at(1).at("held_out").at("values").at(3).at("key"), "s/neutral/outer3");
  const std::string text = tuning_text(tuning);
  EXPECT_NE(text.find("without fold 2"), std::string::npos);
  EXPECT_NE(text.find("the gap of 0.2"), std::string::npos) << text;
}

TEST(Tuning, TheWeightsFileIsReadBackWithTheDatabasesPnt) {
  const Tuning tuning = made_tuning(0.2);
  CostWeights defaults;
  defaults.pnt = 77.0;
  const CostWeights read = parse_cost_weights(tuned_weights_file(tuning), "weights", defaults);
  EXPECT_EQ(read.alpha2, 0.31);
  EXPECT_EQ(read.pnt, 77.0);
}

TEST(Tuning, ThePageNeedsNothingElseAndEscapesNames) {
  const std::string page = tuning_html(made_tuning(0.2));
  EXPECT_NE(page.find("a &amp; b"), std::string::npos);
  EXPECT_EQ(page.find("a & b"), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  // A plot for each weight and for each search.
  std::size_t plots = 0;
  for (std::size_t at = page.find("<svg"); at != std::string::npos;
       at = page.find("<svg", at + 1)) {
    ++plots;
  }
  EXPECT_EQ(plots, 2u + 3u);
}

} // namespace
} // namespace phonomime
