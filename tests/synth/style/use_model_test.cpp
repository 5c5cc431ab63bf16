// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/choose_dimensions.h"
#include "synth/style/choose_unknown.h"
#include "synth/style/content_solver.h"
#include "synth/style/infer_style.h"
#include "synth/style/mixture.h"
#include "tests/support/expect_error.h"
#include "tests/synth/style/made_speech.h"

#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace phonomime::test {

TEST(ContentSolver, SolvesTheNormalEquations) {
  MadeNumbers numbers(1);
  const Eigen::MatrixXd basis = numbers.matrix(9, 4), y = numbers.matrix(9, 6);
  const Eigen::VectorXd mean = numbers.matrix(4, 1);
  const ContentSolver solver(basis, mean);
  const Eigen::MatrixXd squares = basis.transpose() * basis;
  const Eigen::MatrixXd plain = squares.inverse() * (basis.transpose() * y); // T2.10
  EXPECT_LT((solver.solve(y, 0.0) - plain).norm(), 1e-12);
  const Eigen::MatrixXd ridged = ((squares + 0.7 * Eigen::MatrixXd::Identity(4, 4)).inverse() *
                                  (basis.transpose() * (y.colwise() - basis * mean)))
                                     .colwise() +
                                 mean;
  EXPECT_LT((solver.solve(y, 0.7) - ridged).norm(), 1e-12);
  EXPECT_LT((solver.solve(y, 1e12).colwise() - mean).norm(), 1e-9);
}

TEST(ContentSolver, LeavesOutWhatABasisDoesNotShow) {
  MadeNumbers numbers(2);
  Eigen::MatrixXd basis = numbers.matrix(9, 4);
  basis.col(3) = basis.col(2);
  const Eigen::MatrixXd y = basis * numbers.matrix(4, 5);
  const Eigen::MatrixXd contents = ContentSolver(basis, Eigen::VectorXd::Zero(4)).solve(y, 0.0);
  EXPECT_LT((basis * contents - y).norm(), 1e-12);
  EXPECT_LT((contents.row(3) - contents.row(2)).norm(), 1e-12); // of least norm
}

TEST(ContentSolver, TranslatesAsContentsThenBasis) {
  MadeNumbers numbers(3);
  const Eigen::MatrixXd known = numbers.matrix(9, 4), wanted = numbers.matrix(7, 4),
                        y = numbers.matrix(9, 5);
  const ContentSolver solver(known, numbers.matrix(4, 1));
  const Translation step = solver.to(wanted, solver.map(0.2));
  EXPECT_LT(((step.matrix * y).colwise() + step.shift - wanted * solver.solve(y, 0.2)).norm(),
            1e-12);
}

TEST(InferStyle, FindsATrainedStyleAmongFrames) {
  const TrueModel truth(15, 3, 5, 4, 41);
  const SymmetricModel model = fit_symmetric(summarise(truth.speak(made_contents(5, 400, 42))),
                                             {.style_size = 3, .content_size = 5});
  for (Eigen::Index s = 0; s < 4; ++s) {
    const Eigen::MatrixXd contents = made_contents(5, 30, 50 + static_cast<std::uint64_t>(s));
    const Eigen::MatrixXd y = truth.shown_all(truth.expressions.col(s), contents);
    const InferredStyle found =
        infer_style(model, y, {.most_iterations = 5000, .tolerance = 1e-13});
    EXPECT_TRUE(found.converged);
    EXPECT_EQ(nearest_style(model, found.expression), s);
    EXPECT_LT((show(model, found.expression, found.contents) - y).norm(), 1e-6 * y.norm());
    const std::size_t held = 5;
    for (std::size_t i = held + 1; i < found.convergence.size(); ++i) {
      EXPECT_LE(found.convergence[i], found.convergence[i - 1] * (1.0 + 1e-12) + 1e-13);
    }
  }
}

TEST(InferStyle, TranslatesAnUntrainedExpressionBothWays) {
  const TrueModel truth(15, 3, 5, 4, 41);
  const Eigen::MatrixXd trained = made_contents(5, 400, 42);
  const StyleStack stack = truth.speak(trained);
  const SymmetricModel model =
      fit_symmetric(summarise(stack), {.style_size = 3, .content_size = 5});
  const Eigen::VectorXd stranger = 0.6 * truth.expressions.col(0) + 0.7 * truth.expressions.col(1);
  const Eigen::MatrixXd contents = made_contents(5, 60, 43);
  const Eigen::MatrixXd y = truth.shown_all(stranger, contents);
  const InferredStyle found = infer_style(model, y, {.most_iterations = 5000, .tolerance = 1e-13});
  // Its speech with a trained face.
  const Eigen::MatrixXd known = truth.shown_all(truth.expressions.col(2), contents);
  EXPECT_LT((show(model, model.expressions.col(2), found.contents) - known).norm(),
            0.01 * known.norm());
  // Trained speech with its face.
  const Eigen::MatrixXd spoken =
      ContentSolver(model.basis(model.expressions.col(2)), model.mean_content)
          .solve(stack.columns.middleRows(30, 15), 0.0);
  const Eigen::MatrixXd wanted = truth.shown_all(stranger, trained);
  EXPECT_LT((show(model, found.expression, spoken) - wanted).norm(), 0.01 * wanted.norm());
}

TEST(InferStyle, RefusesFramesThatAreNotTheModels) {
  const TrueModel truth(6, 2, 3, 3, 1);
  const SymmetricModel model = fit_symmetric(summarise(truth.speak(made_contents(3, 50, 2))),
                                             {.style_size = 2, .content_size = 3});
  expect_error([&] { infer_style(model, Eigen::MatrixXd::Ones(5, 4), {}); }, "(expected 6, got 5)");
  expect_error([&] { infer_style(model, Eigen::MatrixXd(6, 0), {}); }, "no frame");
  Eigen::MatrixXd y = Eigen::MatrixXd::Ones(6, 4);
  y(2, 2) = std::numeric_limits<double>::infinity();
  expect_error([&] { infer_style(model, y, {}); }, "not finite");
}

TEST(Mixture, WeightsSumToOne) {
  const std::vector<std::string> styles = {"neutral", "happiness", "anger"};
  const auto weights = [&](std::vector<EmotionModifier> parts) {
    return mixture_weights(styles, "neutral", parts);
  };
  const auto near = [](const Eigen::VectorXd& found, double neutral, double happiness,
                       double anger) {
    return (found - Eigen::Vector3d(neutral, happiness, anger)).norm() < 1e-15;
  };
  EXPECT_TRUE(near(weights({}), 1, 0, 0));
  EXPECT_TRUE(near(weights({{"anger", 1.0}}), 0, 0, 1));
  EXPECT_TRUE(near(weights({{"anger", 1.5}}), -0.5, 0, 1.5));
  EXPECT_TRUE(near(weights({{"happiness", 0.6}, {"anger", 0.3}}), 0.1, 0.6, 0.3));
  EXPECT_TRUE(near(weights({{"neutral", 1.5}}), 1, 0, 0));
  expect_error(
      [&] {
        weights({{"boredom", 1.0}});
      },
      "not trained on the emotion boredom (expected neutral, happiness, anger");
}

TEST(Mixture, ShowsTheWeightedSumOfWhatItsStylesShow) { // T2.15
  const TrueModel truth(6, 3, 4, 3, 8);
  const StackSummary data = summarise(truth.speak(made_contents(4, 90, 9)));
  const AsymmetricModel model = fit_asymmetric(data, 4);
  const SymmetricModel symmetric = fit_symmetric(data, {.style_size = 3, .content_size = 4});
  const Eigen::Vector3d weights(-0.5, 1.2, 0.3);
  const Eigen::VectorXd content = MadeNumbers(3).matrix(4, 1);
  const Eigen::VectorXd mixed = mixture_basis(model, weights) * content;
  const Eigen::VectorXd sum = -0.5 * (model.basis(0) * content) + 1.2 * (model.basis(1) * content) +
                              0.3 * (model.basis(2) * content);
  EXPECT_LT((mixed - sum).norm(), 1e-12);
  // In a true model, the mixed style of mixed style vectors.
  const Eigen::MatrixXd contents = made_contents(4, 10, 12);
  const Eigen::MatrixXd known = truth.shown_all(truth.expressions.col(0), contents);
  const Eigen::MatrixXd wanted = truth.shown_all(truth.expressions * weights, contents);
  const ContentSolver solver(model.basis(0), model.mean_content);
  EXPECT_LT((mixture_basis(model, weights) * solver.solve(known, 0.0) - wanted).norm(),
            1e-10 * wanted.norm());
  const ContentSolver other(symmetric.basis(symmetric.expressions.col(0)), symmetric.mean_content);
  EXPECT_LT(
      (show(symmetric, symmetric.expressions * weights, other.solve(known, 0.0)) - wanted).norm(),
      1e-10 * wanted.norm());
}

namespace {

std::vector<StyleStack> made_parts(double noise) {
  const TrueModel truth(8, 3, 5, 3, 61);
  std::vector<StyleStack> parts;
  for (std::uint64_t part = 0; part < 4; ++part) {
    parts.push_back(truth.speak(
        made_contents(5, 80 + 20 * static_cast<Eigen::Index>(part), 70 + part), noise, 80 + part));
  }
  return parts;
}

std::vector<StackSummary> summaries(const std::vector<StyleStack>& parts) {
  std::vector<StackSummary> made;
  for (const StyleStack& part : parts) {
    made.push_back(summarise(part));
  }
  return made;
}

} // namespace

TEST(ChooseDimensions, FindsTheTrueNumberOfContents) {
  const std::vector<StackSummary> parts = summaries(made_parts(0.05));
  const ChosenDimensions chosen = choose_dimensions(parts, {.ridges = {0.0}});
  EXPECT_EQ(chosen.best.content_size, 5);
  EXPECT_LT(chosen.best.error, 0.1 * chosen.mean_difference_error);
  EXPECT_LT(chosen.mean_difference_error, chosen.unchanged_error);
}

TEST(ChooseDimensions, ErrsAsTranslatingFrameByFrame) {
  const std::vector<StyleStack> stacks = made_parts(0.3);
  const std::vector<StackSummary> parts = summaries(stacks);
  const ChosenDimensions chosen = choose_dimensions(
      parts, {.content_sizes = {4}, .ridges = {0.02}, .first_row = 2, .row_count = 3});
  double ours = 0.0, unchanged = 0.0, shifted = 0.0, count = 0.0;
  for (std::size_t left_out = 0; left_out < 4; ++left_out) {
    StyleStack training = stacks[0];
    training.columns.resize(24, 0);
    for (std::size_t part = 0; part < 4; ++part) {
      if (part != left_out) {
        Eigen::MatrixXd both(24, training.columns.cols() + stacks[part].columns.cols());
        both << training.columns, stacks[part].columns;
        training.columns = both;
      }
    }
    const AsymmetricModel model = fit_asymmetric(summarise(training), 4);
    const Eigen::VectorXd mean = training.columns.rowwise().mean();
    for (Eigen::Index from = 0; from < 3; ++from) {
      for (Eigen::Index to = 0; to < 3; ++to) {
        if (from == to) {
          continue;
        }
        for (Eigen::Index t = 0; t < stacks[left_out].columns.cols(); ++t) {
          const Eigen::VectorXd column = stacks[left_out].columns.col(t);
          const Eigen::VectorXd y = column.segment(8 * from, 8), wanted = column.segment(8 * to, 8);
          const Eigen::MatrixXd basis = model.basis(from);
          const Eigen::VectorXd content =
              model.mean_content +
              (basis.transpose() * basis + 0.02 * Eigen::MatrixXd::Identity(4, 4)).inverse() *
                  (basis.transpose() * (y - basis * model.mean_content));
          ours += (model.basis(to) * content - wanted).segment(2, 3).squaredNorm();
          unchanged += (y - wanted).segment(2, 3).squaredNorm();
          shifted += (y + mean.segment(8 * to, 8) - mean.segment(8 * from, 8) - wanted)
                         .segment(2, 3)
                         .squaredNorm();
          count += 3.0;
        }
      }
    }
  }
  EXPECT_NEAR(chosen.best.error, std::sqrt(ours / count), 1e-10);
  EXPECT_NEAR(chosen.unchanged_error, std::sqrt(unchanged / count), 1e-10);
  EXPECT_NEAR(chosen.mean_difference_error, std::sqrt(shifted / count), 1e-10);
}

TEST(ChooseDimensions, ARidgeHelpsWhereContentsAreIllConditioned) {
  const std::vector<StackSummary> parts = summaries(made_parts(0.3));
  const auto best = [&](std::vector<double> ridges) {
    return choose_dimensions(parts, {.content_sizes = {8}, .ridges = std::move(ridges)}).best;
  };
  const Choice ridged = best({0.0, 0.003, 0.01, 0.03, 0.1});
  EXPECT_GT(ridged.ridge, 0.0);
  EXPECT_LT(ridged.error, 0.9 * best({0.0}).error);
}

TEST(ChooseDimensions, GivesTheSameBytesAtAnyThreadCount) {
  const std::vector<StackSummary> parts = summaries(made_parts(0.1));
  const ChosenDimensions one = choose_dimensions(parts, {.threads = 1});
  const ChosenDimensions three = choose_dimensions(parts, {.threads = 3});
  ASSERT_EQ(one.tried.size(), three.tried.size());
  for (std::size_t i = 0; i < one.tried.size(); ++i) {
    EXPECT_EQ(one.tried[i].error, three.tried[i].error);
  }
  EXPECT_EQ(one.best.content_size, three.best.content_size);
  EXPECT_EQ(one.best.ridge, three.best.ridge);
}

TEST(ChooseDimensions, RefusesASinglePart) {
  const std::vector<StackSummary> parts(1, summaries(made_parts(0.0)).front());
  expect_error([&] { choose_dimensions(parts, {}); }, "parts to leave out");
}

TEST(ChooseUnknown, FindsTheDimensionsOfATrueModel) {
  const double noise = 0.05;
  const TrueModel truth(12, 2, 5, 4, 44);
  std::vector<StyleStack> parts;
  std::vector<StackSummary> summaries;
  for (std::uint64_t part = 0; part < 4; ++part) {
    parts.push_back(truth.speak(made_contents(5, 90, 60 + part), noise, 70 + part));
    summaries.push_back(summarise(parts.back()));
  }
  UnknownChoiceOptions options{.content_sizes = {3, 5, 8}, .threads = 1};
  const ChosenUnknown one = choose_unknown(parts, summaries, options);
  ASSERT_EQ(one.tried.size(), 9U); // I 2 to 4
  EXPECT_EQ(one.best.style_size, 2);
  EXPECT_EQ(one.best.content_size, 5);
  EXPECT_EQ(one.best.windows, 4 * 3 * 4); // parts, windows of 30 in 90 columns, styles
  EXPECT_EQ(one.best.found, one.best.windows);
  // Numbers in [-noise, noise], with those of the inference on top.
  EXPECT_GT(one.best.error, noise / std::sqrt(3.0));
  EXPECT_LT(one.best.error, 2.0 * noise / std::sqrt(3.0));
  for (const UnknownChoice& choice : one.tried) {
    EXPECT_TRUE(choice.content_size != 3 || choice.error > 2.0 * one.best.error);
  }
  options.threads = 3;
  const ChosenUnknown three = choose_unknown(parts, summaries, options);
  for (std::size_t i = 0; i < one.tried.size(); ++i) {
    EXPECT_EQ(one.tried[i].error, three.tried[i].error);
    EXPECT_EQ(one.tried[i].found, three.tried[i].found);
  }
  expect_error(
      [&] {
        choose_unknown({parts.data(), 1}, {summaries.data(), 1}, {});
      },
      "parts to leave out");
}

} // namespace phonomime::test
