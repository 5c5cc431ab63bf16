// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/compare.h"

#include "tests/support/expect_error.h"
#include "tests/tools/evaluate/made_evaluation.h"
#include "tools/evaluate/report.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace phonomime::test {
namespace {

Evaluation run_of(int sentences, double error_mm) {
  Evaluation evaluation = made_evaluation(sentences, {{"main", error_mm}, {"other", 1.0}});
  aggregate(evaluation);
  return evaluation;
}

std::string json_of(const Evaluation& evaluation) {
  return evaluation_json(evaluation, std::nullopt).dump();
}

const MeasureComparison& of(const Comparison& comparison, Measure measure) {
  const auto& measures = comparison.methods.at(0).measures;
  return *std::ranges::find(measures, measure, &MeasureComparison::measure);
}

TEST(Compare, ARunIsNoDifferentFromItself) {
  const Evaluation evaluation = run_of(20, 0.5);
  const Comparison comparison =
      compare_runs(evaluation, parse_evaluation(json_of(evaluation), "same.json"));
  ASSERT_EQ(comparison.methods.size(), 2u);
  EXPECT_TRUE(comparison.notes.empty());
  for (const MethodComparison& method : comparison.methods) {
    EXPECT_EQ(method.sentences, 20);
    for (const MeasureComparison& one : method.measures) {
      EXPECT_EQ(one.difference, 0.0) << info(one.measure).id;
      EXPECT_EQ(one.better + one.worse, 0) << info(one.measure).id;
      EXPECT_EQ(one.verdict, info(one.measure).aim == Aim::none ? Verdict::not_compared
                                                                : Verdict::no_difference);
    }
  }
}

TEST(Compare, TheOrderOfSentencesInAReportDoesNotMatter) {
  const Evaluation evaluation = run_of(9, 0.5);
  nlohmann::json turned = nlohmann::json::parse(json_of(evaluation));
  auto& sentences = turned["methods"][0]["sentences"];
  std::reverse(sentences.begin(), sentences.end());
  const Comparison comparison =
      compare_runs(evaluation, parse_evaluation(turned.dump(), "turned.json"));
  EXPECT_EQ(comparison.methods.at(0).sentences, 9);
  EXPECT_EQ(of(comparison, Measure::squared_error).difference, 0.0);
}

TEST(Compare, WhatIsGoodDependsOnTheMeasure) {
  EXPECT_EQ(badness(Measure::rmse, 2.0), 2.0);
  EXPECT_EQ(badness(Measure::closure_recall, 0.75), -0.75);
  EXPECT_EQ(badness(Measure::aperture_deviation_ratio, 0.75), 0.25);
  EXPECT_EQ(badness(Measure::aperture_deviation_ratio, 1.25), 0.25);
  EXPECT_EQ(badness(Measure::upper_face_dynamics, -2.0), 2.0);
  EXPECT_FALSE(badness(Measure::captured_joins, 0.5));
}

TEST(Compare, SeesWhatBecameBetterAndWhatWorse) {
  const Evaluation small = run_of(20, 0.5);
  const Evaluation large = run_of(20, 0.9);
  const Comparison better = compare_runs(small, parse_evaluation(json_of(large), "large.json"));
  const Comparison worse = compare_runs(large, parse_evaluation(json_of(small), "small.json"));
  for (const Measure measure : {Measure::squared_error, Measure::lip_rmse, Measure::velocity_error,
                                Measure::aperture_correlation}) {
    EXPECT_EQ(of(better, measure).verdict, Verdict::better) << info(measure).id;
    EXPECT_EQ(of(better, measure).better, 20);
    EXPECT_EQ(of(worse, measure).verdict, Verdict::worse) << info(measure).id;
    EXPECT_EQ(of(worse, measure).worse, 20);
    EXPECT_LE(of(better, measure).p_value, of(better, measure).adjusted_p);
    EXPECT_NEAR(of(better, measure).difference, -of(worse, measure).difference, 1e-12);
  }
  const MeasureComparison& error = of(better, Measure::squared_error);
  EXPECT_NEAR(error.mean / error.earlier_mean, 0.25 / 0.81, 1e-4);
  EXPECT_NEAR(error.p_value, 2.0 / (1 << 20), 1e-12); // every sentence better: 2 of 2^20 signs
  // The other method is the same in both runs.
  for (const MeasureComparison& one : better.methods.at(1).measures) {
    EXPECT_NE(one.verdict, Verdict::better);
    EXPECT_NE(one.verdict, Verdict::worse);
  }
}

TEST(Compare, AVerdictStandsAgainstAllTheMeasuresLookedAt) {
  const Comparison comparison =
      compare_runs(run_of(14, 0.6), parse_evaluation(json_of(run_of(14, 0.8)), "e.json"));
  int alone = 0; // that would have a verdict if they had been looked at alone
  for (const MeasureComparison& one : comparison.methods.at(0).measures) {
    if (one.verdict == Verdict::not_compared) {
      continue;
    }
    EXPECT_EQ(one.verdict == Verdict::no_difference, one.adjusted_p >= kSignificance);
    alone += one.p_value < kSignificance && one.adjusted_p >= kSignificance ? 1 : 0;
  }
  EXPECT_GE(alone, 1);
}

TEST(Compare, PairsSentencesByKeyAndTheMainMethodsWithEachOther) {
  const Evaluation evaluation = run_of(20, 0.5);
  Evaluation earlier = made_evaluation(12, {{"old", 0.9}});
  earlier.run.held_out_by = "otherwise";
  aggregate(earlier);
  const Comparison comparison =
      compare_runs(evaluation, parse_evaluation(json_of(earlier), "old.json"));
  ASSERT_EQ(comparison.methods.size(), 1u);
  EXPECT_EQ(comparison.methods[0].method, "main");
  EXPECT_EQ(comparison.methods[0].earlier_method, "old");
  EXPECT_EQ(comparison.methods[0].sentences, 12);
  EXPECT_EQ(comparison.notes.size(), 2u); // held out otherwise, fewer sentences
}

TEST(Compare, RefusesRunsThatCannotBeCompared) {
  const Evaluation evaluation = run_of(6, 0.5);
  const nlohmann::json whole = nlohmann::json::parse(json_of(evaluation));
  const auto refused = [&](const std::function<void(nlohmann::json&)>& change,
                           const std::string& part) {
    nlohmann::json changed = whole;
    change(changed);
    expect_error([&] { compare_runs(evaluation, parse_evaluation(changed.dump(), "r.json")); },
                 part);
  };
  refused([](auto& j) { j["corpus"] = "another"; }, "r.json: the report is of another corpus");
  refused([](auto& j) { j["rate"] = 50.0; }, "another rate (expected 100 Hz, got 50)");
  refused([](auto& j) { j["methods"][0]["sentences"][2]["frames"] = 7; }, "is another recording");
  refused([](auto& j) { j["measures"][1]["formula"] = "guessed"; },
          R"(measure "rmse" has another formula there)");
  refused([](auto& j) { j["measures"][0]["unit"] = "cm^2"; }, "another unit");
  refused([](auto& j) { j["measures"][2]["mask"] = "all frames"; }, "another mask");
  refused(
      [](auto& j) {
        for (auto& measure : j["measures"]) {
          measure["id"] = "x" + measure["id"].template get<std::string>();
        }
      },
      "no known measure");
  refused(
      [](auto& j) {
        j["methods"].erase(1);
        j["methods"][0]["id"] = "old";
        j["main_method"] = "lost";
      },
      "no method in common");
  refused(
      [](auto& j) {
        for (auto& method : j["methods"]) {
          for (auto& sentence : method["sentences"]) {
            sentence["key"] = "s2/" + sentence["key"].template get<std::string>();
          }
        }
      },
      "no sentence in common");
  refused([](auto& j) { j["format"] = "phonomime-result"; }, "r.json");
  refused([](auto& j) { j["version"] = 2; }, "r.json");
  refused([](auto& j) { j["methods"][0].erase("sentences"); }, "sentences");
  expect_error([] { parse_evaluation("{", "r.json"); }, "r.json");
}

} // namespace
} // namespace phonomime::test
