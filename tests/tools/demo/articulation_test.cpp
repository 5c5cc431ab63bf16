// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include "db/types/errors.h"
#include "tests/tools/demo/support.h"
#include "tools/demo/dominance.h"
#include "tools/demo/emotion_style.h"
#include "tools/demo/face_fields.h"
#include "tools/demo/marker_layout.h"
#include "tools/demo/mask_face.h"
#include "tools/demo/performance.h"

namespace phonomime::demo {
namespace {

std::vector<Segment> vowel_contact_vowel(const std::string& vowel, const std::string& contact,
                                         double contact_s) {
  return sequence({{"pau", 0.3}, {vowel, 0.14}, {contact, contact_s}, {vowel, 0.14}, {"pau", 0.3}});
}

// Frames within the core of segment `i`.
template <typename Check>
int for_core(const std::vector<Segment>& segments, std::size_t i, const Check& check) {
  const Segment& s = segments[i];
  const double margin_s = kContactMargin * (s.end_s - s.start_s);
  int seen = 0;
  for (int k = 0; k < frame_count(segments.back().end_s, kRate_hz); ++k)
    if (k / kRate_hz >= s.start_s + margin_s && k / kRate_hz < s.end_s - margin_s) {
      check(k);
      ++seen;
    }
  return seen;
}

double distance(const MarkerPose& pose, int a, int b) {
  return (pose.row(marker_index(a)) - pose.row(marker_index(b))).norm();
}

TEST(Articulation, ClosuresCloseAllLipColumnsInEveryEmotionAndTempo) {
  const FaceFields fields(mask_face_model().rest);
  for (const EmotionStyle& style : emotion_styles())
    for (const std::string vowel : {"aa", "iy", "uw", "ae"})
      for (const std::string contact : {"p", "b", "m"})
        for (const double duration_s : {0.03, 0.06, 0.12}) {
          const auto segments = vowel_contact_vowel(vowel, contact, duration_s);
          const Performance performance = perform(segments, style, fields, 5);
          const int seen = for_core(segments, 2, [&](int k) {
            for (const LipColumn& column : kLipColumns) {
              const MarkerPose& face = performance.face[static_cast<std::size_t>(k)];
              EXPECT_LT(distance(face, column.upper_inner, column.lower_inner), 1e-9);
            }
            const MarkerPose& measured = performance.measured[static_cast<std::size_t>(k)];
            EXPECT_LT(std::abs(measured(marker_index(13), 1) - measured(marker_index(14), 1)), 0.7)
                << style.emotion << " " << vowel << contact << " " << duration_s;
          });
          EXPECT_GE(seen, 2);
        }
}

TEST(Articulation, VowelsOpenBesideAClosure) {
  const auto segments = vowel_contact_vowel("aa", "p", 0.06);
  const auto motion = articulate(segments, kRate_hz, {});
  EXPECT_GT(motion[static_cast<std::size_t>(0.36 * kRate_hz)].value[aperture], 8.0);
  EXPECT_GT(motion[static_cast<std::size_t>(0.58 * kRate_hz)].value[aperture], 8.0);
}

TEST(Articulation, LipMeetsTeethInEveryTempo) {
  for (const double duration_s : {0.03, 0.08}) {
    const auto segments = vowel_contact_vowel("aa", "f", duration_s);
    const auto motion = articulate(segments, kRate_hz, {.opening = 1.3});
    const Articulators& bite = articulation_of("f").targets.front().value;
    EXPECT_GE(for_core(segments, 2,
                       [&](int k) {
                         const Articulators& v = motion[static_cast<std::size_t>(k)].value;
                         EXPECT_NEAR(v[tuck], bite[tuck], 1e-9);
                         EXPECT_NEAR(v[aperture], bite[aperture], 1e-9);
                       }),
              2);
  }
}

// Held long enough a sound reaches its target, whatever the dominance functions blend into it.
TEST(Articulation, LongSoundsReachTheirTargets) {
  for (const std::string phoneme : {"aa", "iy", "uw", "s"}) {
    const auto segments = sequence({{"pau", 0.3}, {phoneme, 1.5}, {"pau", 0.3}});
    const auto motion = articulate(segments, kRate_hz, {});
    const Articulators& target = articulation_of(phoneme).targets.front().value;
    for (int a = 0; a < articulator_count; ++a)
      EXPECT_NEAR(motion[static_cast<std::size_t>(1.05 * kRate_hz)].value[a], target[a], 0.02);
  }
}

// Closed form of Cohen and Massaro's blend for two sounds, in the middle of the first one, before
// smoothing: a plateau is wide enough that smoothing leaves it alone.
TEST(Articulation, BlendHasTheClosedFormOfTwoDominanceFunctions) {
  const auto segments = sequence({{"aa", 0.9}, {"uw", 0.9}});
  const auto motion = articulate(segments, kRate_hz, {});
  const ArticulatoryTarget& first = articulation_of("aa").targets.front();
  const ArticulatoryTarget& second = articulation_of("uw").targets.front();
  const double theta = 14.0;
  const double tau_s = 1.2 - 0.45;
  const double d = second.round_dominance * std::exp(-theta * tau_s);
  const double expected =
      (first.round_dominance * first.value[protrusion] + d * second.value[protrusion]) /
      (first.round_dominance + d);
  EXPECT_NEAR(motion[static_cast<std::size_t>(0.45 * kRate_hz)].value[protrusion], expected,
              0.1 * expected);
  EXPECT_GT(expected, 0.0);
}

TEST(Articulation, MovesNoFasterThanLipsAndHasNoContentAbove15Hz) {
  std::vector<Sound> sounds = {{"pau", 0.3}};
  for (const char* phoneme : {"p", "aa", "t", "iy", "m", "ae", "b", "uw", "s", "ao", "f", "ay"})
    sounds.push_back({phoneme, 0.075});
  sounds.push_back({"pau", 0.3});
  const auto motion = articulate(sequence(sounds), kRate_hz, {});
  const std::size_t n = motion.size();
  double fastest = 0.0;
  for (std::size_t k = 1; k < n; ++k)
    fastest = std::max(
        fastest, kRate_hz * std::abs(motion[k].value[aperture] - motion[k - 1].value[aperture]));
  EXPECT_LT(fastest, 350.0);
  EXPECT_GT(fastest, 60.0);
  double all = 0.0;
  double high = 0.0;
  for (std::size_t bin = 1; bin <= n / 2; ++bin) {
    std::complex<double> sum;
    for (std::size_t k = 0; k < n; ++k)
      sum += motion[k].value[aperture] *
             std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(bin * k) /
                                 static_cast<double>(n));
    all += std::norm(sum);
    if (static_cast<double>(bin) * kRate_hz / static_cast<double>(n) > 15.0)
      high += std::norm(sum);
  }
  EXPECT_LT(high / all, 0.01);
}

TEST(Articulation, MouthShapesOfVowelsDiffer) {
  const FaceFields fields(mask_face_model().rest);
  const auto pose_of = [&](const char* phoneme) {
    FaceState state;
    state.speech.value = articulation_of(phoneme).targets.front().value;
    return fields.pose(state);
  };
  const MarkerPose aa = pose_of("aa");
  const MarkerPose iy = pose_of("iy");
  const MarkerPose uw = pose_of("uw");
  const double rest_width = distance(fields.rest(), 61, 291);
  EXPECT_NEAR(aa(marker_index(13), 1) - aa(marker_index(14), 1), 14.0, 1e-9);
  EXPECT_GT(distance(iy, 61, 291), rest_width + 8.0);
  EXPECT_LT(distance(uw, 61, 291), rest_width - 12.0);
  EXPECT_GT(uw(marker_index(13), 2), fields.rest()(marker_index(13), 2) + 5.0);
  EXPECT_LT(aa(marker_index(152), 1), fields.rest()(marker_index(152), 1) - 9.0);
}

TEST(Articulation, UnknownPhonemeNamesTheNearest) {
  try {
    articulation_of("axx");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("\"ax\""), std::string::npos) << error.what();
  }
}

} // namespace
} // namespace phonomime::demo
