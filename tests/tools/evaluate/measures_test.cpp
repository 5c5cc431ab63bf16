// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/measures.h"

#include "db/types/errors.h"
#include "tests/tools/evaluate/made_sentences.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

using enum Measure;
constexpr double kTau = 2.0 * std::numbers::pi;
constexpr double kFloat = 2e-5; // positions are floats of up to 60 mm

MeasureValues measured(const ImportedSentence& sentence, const FrameMatrix& synthesised,
                       const std::vector<JoinPlace>& joins = {}) {
  return measure_values(measure_sentence(made_setup(), sentence, synthesised, joins).sums);
}

// A mouth that opens and closes: mean 6 mm, 4 mm to either side, a period of 20 frames.
double wave(double k) {
  return 6.0 + 4.0 * std::cos(kTau * k / 20.0);
}

TEST(Measures, APerfectSynthesisErrsNowhere) {
  const ImportedSentence sentence = moving_sentence(1);
  const MeasureValues values = measured(sentence, sentence.channels);
  for (const Measure measure :
       {squared_error, rmse, lip_rmse, lip_vertex_error, lip_vertex_error_root, upper_face_dynamics,
        upper_face_dynamics_absolute, velocity_error, lip_velocity_error, contact_error,
        minimum_timing_error, minimum_timing_bias}) {
    EXPECT_EQ(values[measure], 0.0) << info(measure).id;
  }
  for (const Measure measure :
       {aperture_correlation, width_correlation, protrusion_correlation,
        aperture_correlation_warped, width_correlation_warped, protrusion_correlation_warped,
        aperture_deviation_ratio, width_deviation_ratio, aperture_speed_ratio, lip_speed_ratio}) {
    ASSERT_TRUE(values[measure]) << info(measure).id;
    EXPECT_NEAR(*values[measure], 1.0, 1e-12) << info(measure).id;
  }
  EXPECT_EQ(values[closure_recall], values[closure_recall_recorded]);
}

TEST(Measures, AConstantOffsetIsItsOwnError) { // |(2, 3, 6)| = 7
  const ImportedSentence sentence = moving_sentence(2);
  FrameMatrix synthesised = sentence.channels;
  for (int g = 0; g < group_count; ++g) {
    synthesised.middleCols(3 * g, 3).rowwise() += Eigen::RowVector3f(2.0F, 3.0F, 6.0F);
  }
  const MeasureValues values = measured(sentence, synthesised);
  EXPECT_NEAR(*values[squared_error], 49.0, 1e-3);
  EXPECT_NEAR(*values[rmse], 7.0, kFloat);
  EXPECT_NEAR(*values[lip_rmse], 7.0, kFloat);
  EXPECT_NEAR(*values[lip_vertex_error], 49.0, 1e-3);
  EXPECT_NEAR(*values[lip_vertex_error_root], 7.0, kFloat);
  EXPECT_NEAR(*values[velocity_error], 0.0, 1e-2);
  EXPECT_NEAR(*values[aperture_correlation], 1.0, 1e-9);
  EXPECT_NEAR(*values[protrusion_correlation], 1.0, 1e-9);
  EXPECT_NEAR(*values[aperture_deviation_ratio], 1.0, 1e-5);
}

TEST(Measures, AnOffsetOfOneLipMarkerIsTheLargestErrorOfTheLips) {
  const ImportedSentence sentence = moving_sentence(3);
  FrameMatrix synthesised = sentence.channels;
  synthesised.col(3 * right_corner + 2).array() += 3.0F;
  synthesised.col(3 * chin).array() += 5.0F; // no lip
  const MeasureValues values = measured(sentence, synthesised);
  EXPECT_NEAR(*values[squared_error], (9.0 + 25.0) / 8.0, 1e-4);
  EXPECT_NEAR(*values[lip_rmse], std::sqrt(9.0 / 4.0), kFloat);
  EXPECT_NEAR(*values[lip_vertex_error], 9.0, 1e-4);
  const SentenceMeasures whole = measure_sentence(made_setup(), sentence, synthesised, {});
  EXPECT_NEAR(whole.sums.group_error_sq[chin] / static_cast<double>(whole.sums.frames), 25.0, 1e-3);
  EXPECT_NEAR(whole.frame_error[0], (9.0 + 25.0) / 8.0, 1e-4);
}

TEST(Measures, AShiftInTimeIsTheCosineOfItsPhaseAndTheTimingError) {
  ImportedSentence sentence =
      made_sentence({{"pau", 10}, {"aa", 95}, {"b", 10}, {"aa", 95}, {"pau", 10}});
  FrameMatrix synthesised = sentence.channels;
  set_aperture(sentence.channels, wave); // closest at frame 110, in /b/
  set_aperture(synthesised, [](int k) { return wave(k - 3); });
  const MeasureValues values = measured(sentence, synthesised); // ten whole periods
  EXPECT_NEAR(*values[aperture_correlation], std::cos(kTau * 3.0 / 20.0), 1e-6);
  EXPECT_GT(*values[aperture_correlation_warped], 0.99);
  EXPECT_NEAR(*values[aperture_deviation_ratio], 1.0, 1e-6);
  EXPECT_NEAR(*values[minimum_timing_bias], 0.03, 1e-12);
  EXPECT_NEAR(*values[minimum_timing_error], 0.03, 1e-12);
  const MeasureValues back = measured(
      [&] {
        ImportedSentence late = sentence;
        late.channels = synthesised;
        return late;
      }(),
      sentence.channels);
  EXPECT_NEAR(*back[minimum_timing_bias], -0.03, 1e-12);
  EXPECT_NEAR(*back[minimum_timing_error], 0.03, 1e-12);
}

TEST(Measures, AScaledApertureIsTheRatioOfDeviationAndSpeed) {
  ImportedSentence sentence = one_phoneme(200);
  FrameMatrix synthesised = sentence.channels;
  set_aperture(sentence.channels, wave);
  set_aperture(synthesised, [](int k) { return 6.0 + 0.7 * (wave(k) - 6.0); });
  const MeasureValues values = measured(sentence, synthesised);
  EXPECT_NEAR(*values[aperture_deviation_ratio], 0.7, 1e-6);
  EXPECT_NEAR(*values[aperture_speed_ratio], 0.7, 1e-5);
  EXPECT_NEAR(*values[lip_speed_ratio], 0.7, 1e-5);
  EXPECT_NEAR(*values[aperture_correlation], 1.0, 1e-9);
  // The width does not move: no correlation and no ratio, rather than 0 or 1.
  EXPECT_FALSE(values[width_correlation]);
  EXPECT_FALSE(values[width_deviation_ratio]);
}

TEST(Measures, VelocityErrorIsTheNormOfTheDifference) {
  const ImportedSentence sentence = one_phoneme(50);
  FrameMatrix synthesised = sentence.channels;
  for (Eigen::Index k = 0; k < synthesised.rows();
       ++k) { // the chin drifts by (0.3, 0, 0.4) a frame
    synthesised(k, 3 * chin) += 0.3F * static_cast<float>(k);
    synthesised(k, 3 * chin + 2) += 0.4F * static_cast<float>(k);
  }
  const MeasureValues values = measured(sentence, synthesised);
  EXPECT_NEAR(*values[velocity_error], 0.5 * kRate_hz / 8.0, 1e-3);
  EXPECT_EQ(values[lip_velocity_error], 0.0);
}

TEST(Measures, FlatBrowsAreMissedByTheDeviationOfTheirSquare) {
  ImportedSentence sentence = one_phoneme(200);
  FrameMatrix synthesised = sentence.channels;
  const double reach_mm = 2.0;
  for (Eigen::Index k = 0; k < sentence.channels.rows(); ++k) {
    sentence.channels(k, 3 * brow + 1) +=
        static_cast<float>(reach_mm * std::sin(kTau * static_cast<double>(k) / 40.0));
  }
  // The variance of sin^2 over whole periods is 1/8; one of two groups of the upper face moves.
  const double expected = reach_mm * reach_mm / std::sqrt(8.0) / 2.0;
  const MeasureValues values = measured(sentence, synthesised);
  EXPECT_NEAR(*values[upper_face_dynamics], expected, 1e-4);
  EXPECT_NEAR(*values[upper_face_dynamics_absolute], expected, 1e-4);
  // An eyelid that moves as much where it should not makes up for it in the signed sum alone.
  synthesised.col(3 * lid + 1) +=
      sentence.channels.col(3 * brow + 1) - synthesised.col(3 * brow + 1);
  const MeasureValues both = measured(sentence, synthesised);
  EXPECT_NEAR(*both[upper_face_dynamics], 0.0, 1e-4);
  EXPECT_NEAR(*both[upper_face_dynamics_absolute], 2.0 * expected, 2e-4);
}

TEST(Measures, AJumpAtAJoinIsThreeThirdDifferencesOfSeven) {
  const ImportedSentence sentence = one_phoneme(60);
  FrameMatrix synthesised = sentence.channels;
  const double jump_mm = 2.0;
  const Eigen::Index at = 40;
  synthesised.block(at, 3 * chin + 1, synthesised.rows() - at, 1).array() +=
      static_cast<float>(jump_mm);
  const double unit = jump_mm * kRate_hz * kRate_hz * kRate_hz / std::sqrt(8.0);
  const MeasureValues joined = measured(sentence, synthesised, {{at, false}});
  EXPECT_NEAR(*joined[jerk_at_joins], (1.0 + 2.0 + 1.0) * unit / 7.0, 1e-3 * unit);
  EXPECT_EQ(joined[jerk_inside_nodes], 0.0);
  EXPECT_EQ(joined[jerk_recorded], 0.0);
  EXPECT_EQ(joined[captured_joins], 0.0);
  // As recorded, the place is no join; somewhere else, the jump is inside a node.
  const MeasureValues captured = measured(sentence, synthesised, {{at, true}});
  EXPECT_FALSE(captured[jerk_at_joins]);
  EXPECT_EQ(captured[captured_joins], 1.0);
  EXPECT_NEAR(*captured[jerk_inside_nodes], 4.0 * unit / 57.0, 1e-3 * unit);
  const MeasureValues away = measured(sentence, synthesised, {{at - 10, false}, {at - 20, true}});
  EXPECT_EQ(away[jerk_at_joins], 0.0);
  EXPECT_NEAR(*away[jerk_inside_nodes], 4.0 * unit / 50.0, 1e-3 * unit);
  EXPECT_NEAR(*away[captured_joins], 0.5, 1e-12);
}

TEST(Measures, OnlyFramesWithinTheSpeechAndWithoutGapsCount) {
  ImportedSentence sentence =
      made_sentence({{"pau", 10}, {"aa", 10}, {"pau", 10}, {"iy", 10}, {"pau", 5}, {"pau", 5}});
  FrameMatrix synthesised = sentence.channels;
  synthesised.topRows(10).array() += 100.0F;    // before the speech
  synthesised.bottomRows(10).array() += 100.0F; // after it
  synthesised.row(12).array() += 100.0F;        // a gap
  sentence.frame_has_gap[12] = 1;
  EXPECT_EQ(measured(sentence, synthesised)[squared_error], 0.0);
  EXPECT_EQ(measured(sentence, synthesised)[velocity_error], 0.0);
  EXPECT_EQ(measured(sentence, synthesised)[jerk_inside_nodes], 0.0);
  synthesised.row(25).array() += 1.0F; // in the inner pause: 3 mm^2 in one of 29 frames
  const SentenceMeasures whole = measure_sentence(made_setup(), sentence, synthesised, {});
  EXPECT_EQ(whole.first_speech_frame, 10);
  EXPECT_EQ(whole.end_speech_frame, 40);
  EXPECT_EQ(whole.sums.frames, 29);
  EXPECT_NEAR(*measure_values(whole.sums)[squared_error], 3.0 / 29.0, 1e-6);
  EXPECT_EQ(whole.phoneme_sums.at("aa").frames, 9);
  EXPECT_EQ(whole.phoneme_sums.at("iy").frames, 10);
  EXPECT_EQ(whole.phoneme_sums.size(), 2u);
  EXPECT_EQ(measure_values(whole.phoneme_sums.at("iy"))[squared_error], 0.0);
}

TEST(Measures, SilenceAloneHasNoMeasures) {
  const ImportedSentence sentence = made_sentence({{"pau", 30}});
  const MeasureValues values = measured(sentence, sentence.channels);
  for (const Measure measure : all_measures()) {
    EXPECT_FALSE(values[measure]) << info(measure).id;
  }
}

TEST(Measures, WeightsHaveErrorsButNoMouth) {
  MeasureSetup setup;
  setup.layout.kind = LayoutKind::weights;
  setup.layout.groups = {{"jawOpen", {Region::jaw}}, {"mouthClose", {Region::lips}}};
  setup.rate_hz = kRate_hz;
  setup.reference_pose = Eigen::VectorXd::Zero(2);
  ImportedSentence sentence = made_sentence({{"b", 20}, {"f", 20}});
  sentence.channels = FrameMatrix::Zero(40, 2);
  FrameMatrix synthesised = FrameMatrix::Zero(40, 2);
  synthesised.col(0).setConstant(0.5F);
  synthesised.col(1).setConstant(0.25F);
  const MeasureValues values =
      measure_values(measure_sentence(setup, sentence, synthesised, {}).sums);
  EXPECT_NEAR(*values[squared_error], (0.25 + 0.0625) / 2.0, 1e-9);
  EXPECT_NEAR(*values[lip_rmse], 0.25, 1e-9);
  for (const Measure measure :
       {aperture_correlation, aperture_deviation_ratio, aperture_speed_ratio, lip_speed_ratio,
        closure_recall, closure_recall_recorded, closure_kept, contact_error, minimum_timing_error,
        upper_face_dynamics}) {
    EXPECT_FALSE(values[measure]) << info(measure).id;
  }
}

TEST(Measures, AMismatchIsADefectOfTheCaller) {
  const ImportedSentence sentence = one_phoneme(20);
  EXPECT_THROW(measured(sentence, sentence.channels.topRows(39)), InternalError);
  EXPECT_THROW(measured(sentence, sentence.channels.leftCols(21)), InternalError);
  MeasureSetup setup = made_setup();
  setup.reference_pose.conservativeResize(3);
  EXPECT_THROW(measure_sentence(setup, sentence, sentence.channels, {}), InternalError);
}

} // namespace
} // namespace phonomime::test
