// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sentences whose emotion can be told by construction.
#include "tools/evaluate/emotion_classifier.h"

#include "db/types/errors.h"
#include "tests/synth/search/random_tables.h"

#include <gtest/gtest.h>

#include <functional>

namespace phonomime {
namespace {

using enum EmotionFeatures;

// The frames of a sentence, from its first node to its last.
struct Span {
  std::int64_t first = 0, end = 0;
  std::int32_t emotion = 0;
};

std::vector<Span> sentences_of(const MotionTable& table) {
  std::vector<Span> spans(table.sentences.size(), {1 << 30, 0, 0});
  for (const MotionNode& node : table.nodes) {
    Span& span = spans[static_cast<std::size_t>(node.sentence)];
    span.first = std::min(span.first, node.first_frame);
    span.end = std::max(span.end, node.first_frame + node.frame_count);
    span.emotion = node.emotion;
  }
  return spans;
}

// A table whose motion is what `motion` says: of a sentence's number and emotion, a frame within
// it, and a coefficient.
MotionTable made_table(std::uint64_t seed,
                       const std::function<double(int, int, int, int)>& motion) {
  test::Draw draw(seed);
  MotionTable table = test::random_table({.emotions = 2, .sentences = 16}, draw);
  // Every other sentence in the other emotion.
  for (MotionNode& node : table.nodes) {
    node.emotion = node.sentence % 2;
  }
  int number = 0;
  for (const Span& span : sentences_of(table)) {
    for (std::int64_t k = span.first; k < span.end; ++k) {
      for (Eigen::Index c = 0; c < table.coefficients.cols(); ++c) {
        table.coefficients(k, c) = static_cast<float>(
            motion(number, span.emotion, static_cast<int>(k - span.first), static_cast<int>(c)));
      }
    }
    ++number;
  }
  return table;
}

// How many of the sentences of `heard` are taken for what they are.
int recognised(const EmotionClassifier& classifier, const MotionTable& heard) {
  int count = 0;
  for (const Span& span : sentences_of(heard)) {
    FrameMatrix channels(span.end - span.first, heard.pca.channel_count());
    for (std::int64_t k = span.first; k < span.end; ++k) {
      channels.row(k - span.first) =
          heard.pca.reconstruct(heard.coefficients.row(k).cast<double>().transpose())
              .cast<float>()
              .transpose();
    }
    count += classifier.recognise(channels) == span.emotion ? 1 : 0;
  }
  return count;
}

TEST(EmotionClassifier, TellsHowTheFaceStands) {
  const auto motion = [](int sentence, int emotion, int frame, int c) {
    return (c == 1 ? 2.0 * emotion : 0.0) + 0.3 * ((sentence * 7 + frame * 3 + c) % 5);
  };
  const MotionTable training = made_table(1, motion);
  EXPECT_EQ(recognised(EmotionClassifier(training, pose), made_table(1, motion)), 16);
}

TEST(EmotionClassifier, TellsHowMuchItMoves) {
  // Up and down around nothing, twice as far in one emotion: all means are alike.
  const auto motion = [](int, int emotion, int frame, int) {
    return (frame % 2 == 0 ? 1.0 : -1.0) * (1.0 + emotion);
  };
  const MotionTable table = made_table(2, motion);
  EXPECT_GE(recognised(EmotionClassifier(table, pose_and_movement), table), 15);
}

TEST(EmotionClassifier, WeighsWhatVariesWithinAnEmotionLess) {
  // A small difference between the emotions beside a large one between sentences.
  const auto motion = [](int sentence, int emotion, int, int c) {
    return c == 0   ? 60.0 * ((sentence / 2 * 5) % 8)
           : c == 1 ? 1.0 * emotion + 0.01 * sentence
                    : 0.0;
  };
  const MotionTable table = made_table(3, motion);
  EXPECT_EQ(recognised(EmotionClassifier(table, pose), table), 16);
}

TEST(EmotionClassifier, GoesByTheTrainingRecordingsAlone) {
  const auto motion = [](int, int emotion, int, int c) { return c == 0 ? 3.0 * emotion : 0.0; };
  const auto swapped = [](int, int emotion, int, int c) {
    return c == 0 ? 3.0 * (1 - emotion) : 0.0;
  };
  const MotionTable training = made_table(4, motion);
  EXPECT_EQ(recognised(EmotionClassifier(training, pose), made_table(4, swapped)), 0);
}

TEST(EmotionClassifier, NeedsTwoEmotions) {
  MotionTable table = made_table(5, [](int, int, int, int) { return 0.0; });
  for (MotionNode& node : table.nodes) {
    node.emotion = 1;
  }
  EXPECT_THROW(EmotionClassifier(table, pose), InputError);
}

} // namespace
} // namespace phonomime
