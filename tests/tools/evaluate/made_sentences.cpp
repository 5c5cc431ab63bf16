// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tools/evaluate/made_sentences.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace phonomime::test {

namespace {

constexpr std::array<std::array<double, 3>, group_count> kRest = {{{0.0, -29.0, 10.0},
                                                                   {0.0, -31.0, 10.0},
                                                                   {-25.0, -30.0, 4.0},
                                                                   {25.0, -30.0, 4.0},
                                                                   {0.0, -60.0, 0.0},
                                                                   {20.0, 40.0, 5.0},
                                                                   {20.0, 30.0, 3.0},
                                                                   {0.0, 60.0, 0.0}}};

} // namespace

Layout made_layout() {
  Layout layout;
  layout.groups = {{"upper", {Region::lips}},  {"lower", {Region::lips}}, {"right", {Region::lips}},
                   {"left", {Region::lips}},   {"chin", {Region::jaw}},   {"brow", {Region::brows}},
                   {"lid", {Region::eyelids}}, {"skull", {Region::rigid}}};
  layout.landmarks = {{"lip_upper_inner", "upper"},
                      {"lip_lower_inner", "lower"},
                      {"mouth_corner_right", "right"},
                      {"mouth_corner_left", "left"}};
  return layout;
}

MeasureSetup made_setup() {
  return {made_layout(), kRate_hz, rest_pose()};
}

Eigen::VectorXd rest_pose() {
  Eigen::VectorXd pose(3 * group_count);
  for (int g = 0; g < group_count; ++g) {
    for (int c = 0; c < 3; ++c) {
      pose[3 * g + c] = kRest[g][c];
    }
  }
  return pose;
}

ImportedSentence made_sentence(const std::vector<MadeRow>& rows, const std::string& id) {
  ImportedSentence sentence;
  sentence.speaker = "s1";
  sentence.emotion = "neutral";
  sentence.id = id;
  int frames = 0;
  for (const MadeRow& row : rows) {
    const double start_s = frames / kRate_hz;
    frames += row.frames;
    sentence.rows.push_back({{row.phoneme, row.phoneme}, start_s, frames / kRate_hz});
  }
  sentence.channels = rest_pose().cast<float>().transpose().replicate(frames, 1);
  sentence.frame_has_gap.assign(static_cast<std::size_t>(frames), 0);
  return sentence;
}

ImportedSentence one_phoneme(int frames) {
  return made_sentence({{"pau", 10}, {"aa", frames}, {"pau", 10}});
}

void set_aperture(FrameMatrix& frames, const std::function<double(int)>& aperture_mm) {
  for (Eigen::Index k = 0; k < frames.rows(); ++k) {
    const double half = aperture_mm(static_cast<int>(k)) / 2.0;
    frames(k, 3 * upper_lip + 1) = static_cast<float>(-30.0 + half);
    frames(k, 3 * lower_lip + 1) = static_cast<float>(-30.0 - half);
  }
}

ImportedSentence moving_sentence(int seed) {
  ImportedSentence sentence = made_sentence({{"pau", 12},
                                             {"b", 9},
                                             {"ih", 8},
                                             {"n", 7},
                                             {"pau", 5},
                                             {"f", 10},
                                             {"ao", 14},
                                             {"m", 8 + seed % 4},
                                             {"v", 9},
                                             {"iy", 12},
                                             {"pau", 11}},
                                            "made" + std::to_string(seed));
  for (Eigen::Index k = 0; k < sentence.channels.rows(); ++k) {
    for (Eigen::Index c = 0; c < sentence.channels.cols(); ++c) {
      const double phase = 0.7 * static_cast<double>(c) + 1.3 * seed;
      sentence.channels(k, c) += static_cast<float>(
          1.2 * std::sin(0.21 * static_cast<double>(k) + phase) +
          0.4 * std::sin((0.05 * static_cast<double>(c % 7) + 0.6) * static_cast<double>(k)));
    }
  }
  return sentence;
}

FrameMatrix erring_synthesis(const ImportedSentence& sentence, int seed, double error_mm) {
  FrameMatrix frames = sentence.channels;
  for (Eigen::Index k = 0; k < frames.rows(); ++k) {
    for (Eigen::Index c = 0; c < frames.cols(); ++c) {
      const double phase = 1.9 * static_cast<double>(c) + 0.4 * seed;
      frames(k, c) +=
          static_cast<float>(error_mm * std::sin(0.17 * static_cast<double>(k) + phase));
    }
  }
  return frames;
}

} // namespace phonomime::test
