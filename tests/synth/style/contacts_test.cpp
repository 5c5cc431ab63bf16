// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/contacts.h"

#include "db/types/lip_measures.h"
#include "tests/support/expect_error.h"
#include "tests/synth/style/made_speech.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace phonomime::test {

namespace {

struct Mouth {
  Layout layout;
  PcaModel pca;

  Mouth() {
    for (const char* name : {"upper", "lower", "brow"}) {
      layout.groups.push_back({name, {Region::lips}});
    }
    layout.landmarks = {{"lip_upper_inner", "upper"}, {"lip_lower_inner", "lower"}};
    MadeNumbers numbers(17);
    pca.mean = numbers.matrix(9, 1);
    pca.mean[1] = 6.0; // the mouth is open by some 6 mm on the average
    pca.basis = Eigen::HouseholderQR<Eigen::MatrixXd>(numbers.matrix(9, 4)).householderQ() *
                Eigen::MatrixXd::Identity(9, 4);
    pca.variance = Eigen::Vector4d(9.0, 4.0, 1.0, 0.25);
  }

  CoefficientAperture aperture() const { return *CoefficientAperture::of(layout, pca); }

  // Coefficients whose aperture is as given at every frame, with something else in them too.
  FrameMatrixD moving(const Eigen::VectorXd& apertures) const {
    const CoefficientAperture lips = aperture();
    FrameMatrixD frames = MadeNumbers(4).matrix(apertures.size(), 4);
    for (Eigen::Index t = 0; t < apertures.size(); ++t) {
      frames.row(t) +=
          (apertures[t] - lips.at(frames.row(t))) * lips.gradient() / lips.gradient().squaredNorm();
    }
    return frames;
  }
};

double smallest(const CoefficientAperture& lips, const FrameMatrixD& frames,
                const Contact& contact) {
  double least = lips.at(frames.row(contact.first));
  for (Eigen::Index t = contact.first; t < contact.first + contact.count; ++t) {
    least = std::min(least, lips.at(frames.row(t)));
  }
  return least;
}

// A mouth that closes to `least` every 20 frames, at frame 10 first.
Eigen::VectorXd closing(Eigen::Index count, double least) {
  Eigen::VectorXd apertures(count);
  for (Eigen::Index t = 0; t < count; ++t) {
    const double away = std::abs(static_cast<double>((t + 10) % 20) - 0.0);
    apertures[t] = least + 0.5 * std::min(away, 20.0 - away);
  }
  return apertures;
}

} // namespace

TEST(CoefficientAperture, IsThatOfTheChannels) {
  const Mouth mouth;
  const LipMeasures measures(mouth.layout);
  const CoefficientAperture lips = mouth.aperture();
  const FrameMatrixD frames = MadeNumbers(2).matrix(5, 4);
  for (Eigen::Index t = 0; t < 5; ++t) {
    const Eigen::VectorXd channels = mouth.pca.reconstruct(frames.row(t).transpose());
    EXPECT_NEAR(lips.at(frames.row(t)), *measures.aperture_mm({channels.data(), 9}), 1e-12);
  }
  Layout weights = mouth.layout;
  weights.landmarks.clear();
  EXPECT_FALSE(CoefficientAperture::of(weights, mouth.pca));
}

TEST(Contacts, AreBroughtBackIntoTheirRange) {
  const Mouth mouth;
  const CoefficientAperture lips = mouth.aperture();
  const FrameMatrixD frames = mouth.moving(closing(100, 2.5));
  const std::vector<Contact> contacts = {{8, 5, 0.0, 1.0},
                                         {28, 5, 0.0, 3.0},
                                         {34, 3, 3.0, 3.2},
                                         {48, 6, 3.0, 4.0},
                                         {68, 5, -1.0, 0.5}};
  const HeldContacts held = hold_contacts(frames, 100.0, contacts, lips, mouth.pca.variance, 0.08);
  EXPECT_EQ(held.left, 0);
  EXPECT_EQ(held.moved, 4);
  for (const Contact& contact : contacts) {
    const double least = smallest(lips, held.coefficients, contact);
    EXPECT_LT(least, contact.most_mm + 1e-5);
    EXPECT_GT(least, contact.least_mm - 1e-5);
  }
  // Away from contacts nothing moves, and no frame moves by leaps.
  EXPECT_EQ(held.coefficients.bottomRows(18), frames.bottomRows(18));
  EXPECT_EQ(held.coefficients.row(0), frames.row(0));
  const FrameMatrixD change = held.coefficients - frames;
  for (Eigen::Index t = 1; t < 100; ++t) {
    EXPECT_LT(std::abs(lips.at(change.row(t)) - lips.at(change.row(t - 1))), 0.8) << t;
  }
}

TEST(Contacts, MoveByAsFewStandardDeviationsAsCanBe) {
  const Mouth mouth;
  const CoefficientAperture lips = mouth.aperture();
  const FrameMatrixD frames = mouth.moving(closing(21, 2.5));
  const std::vector<Contact> contacts = {{8, 5, 0.0, 1.0}};
  const HeldContacts held = hold_contacts(frames, 100.0, contacts, lips, mouth.pca.variance);
  const Eigen::RowVectorXd moved = held.coefficients.row(10) - frames.row(10);
  const auto length = [&](const Eigen::RowVectorXd& change) {
    return change.cwiseAbs2().cwiseQuotient(mouth.pca.variance.transpose()).sum();
  };
  EXPECT_NEAR(moved.dot(lips.gradient()), -1.5, 1e-6);
  MadeNumbers numbers(8);
  for (int i = 0; i < 50; ++i) {
    Eigen::RowVectorXd other = moved + 0.1 * numbers.matrix(1, 4);
    other *= moved.dot(lips.gradient()) / other.dot(lips.gradient());
    EXPECT_GE(length(other), length(moved) * (1.0 - 1e-12));
  }
}

TEST(Contacts, ThatKeepTheirRangeChangeNothing) {
  const Mouth mouth;
  const CoefficientAperture lips = mouth.aperture();
  const FrameMatrixD frames = mouth.moving(closing(60, 0.8));
  const ContactRanges ranges = {{"p", {0.0, 3.0}}, {"f", {1.0, 2.0}}};
  const std::vector<PhonemeFrames> phonemes = {{"p", 8, 5}, {"a", 13, 10}, {"f", 28, 5}};
  const std::vector<Contact> contacts = contacts_to_hold(phonemes, ranges, lips, frames);
  ASSERT_EQ(contacts.size(), 2U);
  EXPECT_NEAR(contacts[0].most_mm, 1.45, 1e-9); // closed lips stay closed, whatever others do
  EXPECT_NEAR(contacts[0].least_mm, 0.0, 1e-9);
  EXPECT_NEAR(contacts[1].least_mm, 0.8, 1e-9); // as the motion itself has it
  EXPECT_NEAR(contacts[1].most_mm, 2.0, 1e-9);
  const HeldContacts held = hold_contacts(frames, 100.0, contacts, lips, mouth.pca.variance);
  EXPECT_EQ(held.moved, 0);
  EXPECT_EQ(held.coefficients, frames);
}

TEST(Contacts, RangesAreTheRecordingsPercentiles) {
  const Mouth mouth;
  MotionTable table;
  table.layout = mouth.layout;
  table.pca = mouth.pca;
  table.phonemes = {{"pau", "pau"}, {"m", "b"}, {"a", "a"}};
  Eigen::VectorXd apertures(22);
  for (int n = 0; n < 11; ++n) { // of two frames each, the second the smaller: 0, 1, ... 10 mm
    apertures[2 * n] = n + 0.5;
    apertures[2 * n + 1] = n;
    MotionNode node;
    node.phoneme = 1;
    node.first_frame = 2 * n;
    node.frame_count = 2;
    table.nodes.push_back(node);
  }
  table.nodes.push_back(table.nodes.front());
  table.nodes.back().phoneme = 2;
  table.coefficients = mouth.moving(apertures).cast<float>();
  const ContactRanges ranges = recorded_contacts(table, mouth.aperture());
  ASSERT_EQ(ranges.size(), 1U);
  EXPECT_NEAR(ranges.at("m").least_mm, 1.0, 1e-4);
  EXPECT_NEAR(ranges.at("m").most_mm, 9.0, 1e-4);
}

} // namespace phonomime::test
