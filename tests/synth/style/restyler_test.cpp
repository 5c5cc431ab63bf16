// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/restyler.h"

#include "synth/style/mixture.h"
#include "tests/support/expect_error.h"
#include "tests/synth/style/made_speech.h"

#include <limits>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace phonomime::test {

namespace {

// Three styles whose coefficients (6) are linear in three contents and a constant.
struct MadeStyles {
  PcaModel pca;
  std::vector<Eigen::MatrixXd> coefficients; // S of 6 by 4: times [contents; 1]
  StackSummary data;

  explicit MadeStyles(int bundle, double noise = 0.0) {
    MadeNumbers numbers(7);
    pca.mean = 30.0 * numbers.matrix(9, 1);
    pca.basis = Eigen::HouseholderQR<Eigen::MatrixXd>(numbers.matrix(9, 6)).householderQ() *
                Eigen::MatrixXd::Identity(9, 6);
    const FrameVectors vectors(pca, bundle);
    StyleStack stack{.styles = {"neutral", "anger", "joy"}, .vector_size = vectors.vector_size()};
    const Eigen::MatrixXd said = contents(500, 8);
    stack.columns.resize(3 * vectors.vector_size(), 500);
    for (Eigen::Index s = 0; s < 3; ++s) {
      coefficients.push_back(numbers.matrix(6, 4));
      const FrameMatrixD frames =
          spoken(static_cast<std::size_t>(s), said) + noise * numbers.matrix(500, 6);
      stack.columns.middleRows(s * vectors.vector_size(), vectors.vector_size()) =
          vectors.bundles(frames);
    }
    data = summarise(stack);
  }

  static Eigen::MatrixXd contents(Eigen::Index count, std::uint64_t seed) {
    return MadeNumbers(seed).matrix(3, count);
  }

  FrameMatrixD spoken(std::size_t style, const Eigen::MatrixXd& said) const {
    return ((coefficients[style].leftCols(3) * said).colwise() + coefficients[style].col(3))
        .transpose();
  }
};

Eigen::MatrixXd all_of(Eigen::Index style, Eigen::Index count) {
  return Eigen::Vector3d::Unit(style).replicate(1, count);
}

} // namespace

TEST(Restyler, SpeaksATrueModelsSentenceInAnotherStyle) {
  const MadeStyles made(1);
  const Restyler restyler(fit_asymmetric(made.data, 4), FrameVectors(made.pca, 1), 0.0);
  const Eigen::MatrixXd said = MadeStyles::contents(40, 9);
  const FrameMatrixD found = restyler.restyle(made.spoken(1, said), all_of(1, 40), all_of(2, 40));
  EXPECT_LT((found - made.spoken(2, said)).norm(), 1e-9);
  // Half of each, T2.15.
  const FrameMatrixD half =
      restyler.restyle(made.spoken(1, said), all_of(1, 40), 0.5 * (all_of(1, 40) + all_of(2, 40)));
  EXPECT_LT((half - 0.5 * (made.spoken(1, said) + made.spoken(2, said))).norm(), 1e-9);
}

TEST(Restyler, AddsTheDifferenceOfTheBasesToWhatIsThere) {
  const MadeStyles made(3, 0.4);
  const FrameVectors vectors(made.pca, 3);
  const AsymmetricModel model = fit_asymmetric(made.data, 9);
  const FrameMatrixD frames = MadeNumbers(3).matrix(25, 6);
  const Eigen::MatrixXd y = vectors.bundles(frames);
  const Eigen::MatrixXd basis = model.basis(2);
  const Eigen::MatrixXd contents =
      (basis.transpose() * basis + 0.3 * Eigen::MatrixXd::Identity(9, 9))
          .completeOrthogonalDecomposition()
          .solve(basis.transpose() * (y.colwise() - basis * model.mean_content))
          .colwise() +
      model.mean_content;
  const Eigen::MatrixXd change =
      ((-0.5 * model.basis(0) + 1.5 * model.basis(1) - basis) * contents).middleRows(7, 6);
  const Eigen::MatrixXd wanted = Eigen::Vector3d(-0.5, 1.5, 0.0).replicate(1, 25);
  const FrameMatrixD found = Restyler(model, vectors, 0.3).restyle(frames, all_of(2, 25), wanted);
  EXPECT_LT((found - frames - change.transpose()).norm(), 1e-9);
}

TEST(Restyler, AStyleThatIsKeptChangesNothing) {
  const MadeStyles made(3, 0.4);
  const Restyler restyler(fit_asymmetric(made.data, 9), FrameVectors(made.pca, 3), 0.3);
  const FrameMatrixD frames = MadeNumbers(3).matrix(25, 6);
  Eigen::MatrixXd shown = all_of(2, 25), wanted = shown;
  EXPECT_EQ(restyler.restyle(frames, shown, wanted), frames);
  wanted.col(10) = Eigen::Vector3d::Unit(0);
  const FrameMatrixD found = restyler.restyle(frames, shown, wanted);
  EXPECT_EQ(found.topRows(10), frames.topRows(10));
  EXPECT_EQ(found.bottomRows(14), frames.bottomRows(14));
  EXPECT_GT((found.row(10) - frames.row(10)).norm(), 0.1);
}

TEST(Restyler, RefusesMotionThatIsNotTheModels) {
  const MadeStyles made(3);
  const AsymmetricModel model = fit_asymmetric(made.data, 4);
  expect_error([&] { Restyler(model, FrameVectors(made.pca, 5), 0.0); },
               "another size than that which it was trained on (expected 21, got 35)");
  const Restyler restyler(model, FrameVectors(made.pca, 3), 0.0);
  FrameMatrixD frames = MadeNumbers(3).matrix(5, 6);
  EXPECT_THROW(restyler.restyle(frames, all_of(0, 4), all_of(0, 5)), InternalError);
  frames(2, 2) = std::numeric_limits<double>::quiet_NaN();
  expect_error([&] { restyler.restyle(frames, all_of(0, 5), all_of(1, 5)); }, "not finite");
}

TEST(Glide, TurnsAJumpIntoARaisedCosine) {
  Eigen::MatrixXd weights(2, 60);
  weights.leftCols(30) = Eigen::Vector2d(1.0, 0.0).replicate(1, 30);
  weights.rightCols(30) = Eigen::Vector2d(-0.5, 1.5).replicate(1, 30);
  const Eigen::MatrixXd found = glide(weights, 100.0, 0.2); // 10 frames on either side
  EXPECT_EQ(found.leftCols(20), weights.leftCols(20));
  EXPECT_EQ(found.rightCols(20), weights.rightCols(20));
  EXPECT_LT((found.colwise().sum().array() - 1.0).abs().maxCoeff(), 1e-14);
  for (Eigen::Index t = 1; t < 60; ++t) {
    EXPECT_GE(found(1, t), found(1, t - 1));
    EXPECT_LT(found(1, t) - found(1, t - 1), 1.5 * 0.1);     // no step larger than the kernel's top
    EXPECT_NEAR(found(1, t) + found(1, 59 - t), 1.5, 1e-13); // as it comes, so it goes
  }
  EXPECT_EQ(glide(weights, 100.0, 0.0), weights);
}

} // namespace phonomime::test
