// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/bilinear_model.h"
#include "tests/support/expect_error.h"
#include "tests/synth/style/made_speech.h"

#include <cmath>
#include <limits>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <gtest/gtest.h>

namespace phonomime::test {

namespace {

// Root mean square of a matrix' numbers.
double size_of(const Eigen::MatrixXd& matrix) {
  return matrix.norm() / std::sqrt(static_cast<double>(matrix.size()));
}

// The projector onto the space that a matrix' columns span.
Eigen::MatrixXd projector(const Eigen::MatrixXd& columns) {
  return columns * columns.completeOrthogonalDecomposition().pseudoInverse();
}

} // namespace

TEST(StyleStack, ASummaryHasTheStacksSquaresAndMeans) {
  const TrueModel truth(4, 2, 5, 3, 1);
  const StyleStack stack = truth.speak(made_contents(5, 331, 2), 0.5);
  const StackSummary summary = summarise(stack);
  EXPECT_EQ(summary.factor.cols(), 12);
  const Eigen::MatrixXd squares = stack.columns * stack.columns.transpose();
  EXPECT_LT((summary.factor * summary.factor.transpose() - squares).norm(), 1e-11 * squares.norm());
  EXPECT_LT((summary.mean - stack.columns.rowwise().mean()).norm(), 1e-13);
}

TEST(StyleStack, PartsMergeToTheWhole) {
  const TrueModel truth(4, 2, 5, 3, 1);
  const StyleStack stack = truth.speak(made_contents(5, 100, 2), 0.5);
  StyleStack first = stack, second = stack;
  first.columns = stack.columns.leftCols(5);
  second.columns = stack.columns.rightCols(95);
  const StackSummary parts[] = {summarise(first), summarise(second)};
  const StackSummary* pointers[] = {&parts[0], &parts[1]};
  const StackSummary merged = merge_summaries(pointers);
  const StackSummary whole = summarise(stack);
  EXPECT_EQ(merged.content_count, 100.0);
  EXPECT_LT((merged.mean - whole.mean).norm(), 1e-13);
  EXPECT_LT((merged.factor * merged.factor.transpose() - stack.columns * stack.columns.transpose())
                .norm(),
            1e-11 * stack.columns.squaredNorm());
}

TEST(StyleStack, RefusesWhatNoModelCanBeMadeOf) {
  StyleStack stack{.styles = {"neutral"}, .vector_size = 2, .columns = Eigen::MatrixXd::Ones(2, 5)};
  expect_error([&] { summarise(stack); }, "several styles (expected at least 2, got 1)");
  stack.styles = {"neutral", "neutral"};
  expect_error([&] { summarise(stack); }, "named twice");
  stack.styles = {"neutral", "anger"};
  EXPECT_THROW(summarise(stack), InternalError);
  stack.columns = Eigen::MatrixXd(4, 0);
  expect_error([&] { summarise(stack); }, "no speech that was recorded in every style");
  stack.columns = Eigen::MatrixXd::Ones(4, 5);
  stack.columns(3, 2) = std::numeric_limits<double>::quiet_NaN();
  expect_error([&] { summarise(stack); }, "not finite");
  stack.columns.setZero();
  expect_error([&] { summarise(stack); }, "nothing moves");
}

TEST(AsymmetricModel, IsTheSingularValueDecompositionOfTheWholeMatrix) {
  const TrueModel truth(5, 3, 6, 4, 3);
  const StyleStack stack = truth.speak(made_contents(6, 257, 4), 0.3);
  const AsymmetricModel model = fit_asymmetric(summarise(stack), 4);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(stack.columns,
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  const double scale = std::sqrt(257.0);
  EXPECT_LT((model.spectrum * scale - svd.singularValues()).norm(),
            1e-11 * svd.singularValues()[0]);
  const Eigen::MatrixXd best = svd.matrixU().leftCols(4) *
                               svd.singularValues().head(4).asDiagonal() *
                               svd.matrixV().leftCols(4).transpose();
  EXPECT_NEAR(model.residual, size_of(stack.columns - best), 1e-12);
  // B B' = U S^2 U' / T whatever the signs.
  const Eigen::MatrixXd squares = best * best.transpose() / 257.0;
  EXPECT_LT((model.bases * model.bases.transpose() - squares).norm(), 1e-11 * squares.norm());
  const Eigen::VectorXd mean = svd.matrixV().leftCols(4).colwise().mean() * scale;
  EXPECT_LT((model.mean_content.cwiseAbs() - mean.cwiseAbs()).norm(), 1e-10);
}

TEST(AsymmetricModel, RecoversATrueModelToNumericalPrecision) {
  const TrueModel truth(12, 3, 5, 4, 5);
  const AsymmetricModel model = fit_asymmetric(summarise(truth.speak(made_contents(5, 400, 6))), 5);
  EXPECT_LT(model.residual, 1e-13 * model.spectrum[0]);
  EXPECT_LT(model.spectrum[5], 1e-13 * model.spectrum[0]);
  // New speech in one style gives the same speech in another, T2.10 and T2.11.
  const Eigen::MatrixXd contents = made_contents(5, 20, 7);
  const Eigen::MatrixXd known = truth.shown_all(truth.expressions.col(1), contents);
  const Eigen::MatrixXd wanted = truth.shown_all(truth.expressions.col(3), contents);
  const Eigen::MatrixXd found =
      model.basis(3) * model.basis(1).completeOrthogonalDecomposition().solve(known);
  EXPECT_LT((found - wanted).norm(), 1e-11 * wanted.norm());
}

TEST(AsymmetricModel, RecoversANoisyModelWithinTheNoise) {
  const TrueModel truth(12, 3, 5, 4, 5);
  const Eigen::MatrixXd contents = made_contents(5, 4000, 6);
  const double noise = 0.02 / std::sqrt(3.0); // of numbers in [-0.02, 0.02]
  const StyleStack noisy = truth.speak(contents, 0.02);
  const AsymmetricModel model = fit_asymmetric(summarise(noisy), 5);
  // 5 of 48 dimensions of the noise go into the model.
  EXPECT_NEAR(model.residual, noise * std::sqrt(43.0 / 48.0), 0.02 * noise);
  const Eigen::MatrixXd clean = truth.speak(contents).columns;
  const Eigen::MatrixXd shown = projector(model.bases) * noisy.columns;
  EXPECT_LT(size_of(shown - clean), 0.4 * noise);
}

TEST(AsymmetricModel, RefusesSizesThatTheDataDoNotHave) {
  const TrueModel truth(4, 2, 3, 3, 1);
  const StackSummary data = summarise(truth.speak(made_contents(3, 7, 2)));
  expect_error([&] { fit_asymmetric(data, 0); }, "content dimensions is out of range");
  expect_error([&] { fit_asymmetric(data, 8); }, "(expected 1 to 7, got 8)");
}

TEST(VectorTranspose, ChangesBlocksAndColumns) {
  Eigen::MatrixXd y(4, 3); // two styles of two numbers, three contents
  y << 1, 2, 3,            //
      4, 5, 6,             //
      7, 8, 9,             //
      10, 11, 12;
  Eigen::MatrixXd transposed(6, 2);
  transposed << 1, 7, 4, 10, 2, 8, 5, 11, 3, 9, 6, 12;
  EXPECT_EQ(vector_transpose(y, 2), transposed);
  EXPECT_EQ(vector_transpose(transposed, 2), y);
}

TEST(SymmetricModel, RecoversATrueModelToNumericalPrecision) {
  const TrueModel truth(9, 2, 5, 4, 11);
  const StyleStack stack = truth.speak(made_contents(5, 300, 12));
  const SymmetricModel model =
      fit_symmetric(summarise(stack), {.style_size = 2, .content_size = 5});
  EXPECT_TRUE(model.converged);
  EXPECT_LT(model.convergence.back(), 1e-13 * size_of(stack.columns));
  // The style vectors are the true ones in another basis.
  EXPECT_LT(
      (projector(model.expressions.transpose()) - projector(truth.expressions.transpose())).norm(),
      1e-10);
  const Eigen::MatrixXd squares = model.expressions * model.expressions.transpose();
  EXPECT_LT((squares - Eigen::MatrixXd::Identity(2, 2)).norm(), 1e-13);
  // Any mean of styles is a mean of what they show.
  const Eigen::VectorXd mean = (model.basis(model.expressions.col(2)) * model.mean_content);
  EXPECT_LT((mean - stack.columns.middleRows(18, 9).rowwise().mean()).norm(), 1e-11 * mean.norm());
}

TEST(SymmetricModel, RecoversANoisyModelWithinTheNoise) {
  const TrueModel truth(9, 2, 5, 4, 11);
  const Eigen::MatrixXd contents = made_contents(5, 3000, 12);
  const double noise = 0.02 / std::sqrt(3.0);
  const SymmetricModel model =
      fit_symmetric(summarise(truth.speak(contents, 0.02)), {.style_size = 2, .content_size = 5});
  EXPECT_TRUE(model.converged);
  EXPECT_NEAR(model.convergence.back(), noise * std::sqrt(31.0 / 36.0), 0.02 * noise);
}

TEST(SymmetricModel, TheErrorNeverRises) {
  for (std::uint64_t seed = 20; seed < 26; ++seed) {
    // Styles of six dimensions seen through two, so that there is something to iterate for.
    const TrueModel truth(7, 6, 9, 6, seed);
    const StyleStack stack = truth.speak(MadeNumbers(seed).matrix(9, 200), 0.1);
    const SymmetricModel model =
        fit_symmetric(summarise(stack), {.style_size = 2, .content_size = 3});
    EXPECT_TRUE(model.converged);
    EXPECT_GT(model.convergence.size(), 3U);
    EXPECT_LT(model.convergence.back(), model.convergence.front());
    for (std::size_t i = 1; i < model.convergence.size(); ++i) {
      EXPECT_LE(model.convergence[i], model.convergence[i - 1] * (1.0 + 1e-14)) << seed << " " << i;
    }
  }
}

TEST(SymmetricModel, WithADimensionForEachStyleOnePassIsTheAsymmetricModel) {
  const TrueModel truth(6, 4, 8, 4, 31);
  const StackSummary data = summarise(truth.speak(made_contents(8, 150, 32), 0.2));
  const SymmetricModel model = fit_symmetric(data, {.style_size = 4, .content_size = 5});
  const AsymmetricModel plain = fit_asymmetric(data, 5);
  EXPECT_EQ(model.convergence.size(), 1U);
  EXPECT_NEAR(model.convergence[0], plain.residual, 1e-12);
  for (Eigen::Index s = 0; s < 4; ++s) {
    const Eigen::MatrixXd basis = model.basis(model.expressions.col(s));
    const Eigen::MatrixXd expected = plain.basis(s);
    EXPECT_LT((basis * basis.transpose() - expected * expected.transpose()).norm(),
              1e-11 * expected.squaredNorm());
  }
}

TEST(SymmetricModel, RefusesSizesThatTheDataDoNotHave) {
  const TrueModel truth(4, 2, 3, 3, 1);
  const StackSummary data = summarise(truth.speak(made_contents(3, 50, 2)));
  expect_error([&] { fit_symmetric(data, {.style_size = 4, .content_size = 2}); },
               "style dimensions is out of range (expected 1 to 3, got 4)");
  expect_error([&] { fit_symmetric(data, {.style_size = 2, .content_size = 9}); },
               "content dimensions is out of range (expected 1 to 8, got 9)");
}

} // namespace phonomime::test
