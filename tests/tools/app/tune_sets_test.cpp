// SPDX-License-Identifier: GPL-3.0-or-later
//
// Folds within folds have no sentence in common.
#include "tools/app/tune_sets.h"

#include "db/types/errors.h"
#include "db/types/sentence_key.h"
#include "tools/app/folds.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <fmt/format.h>

namespace phonomime {
namespace {

const TuneLots kLots{.folds = 4, .inner = 3, .sentences = 8, .held_out = 0, .seed = 3};

Corpus made_corpus(int texts, const std::vector<std::string>& emotions) {
  Corpus corpus;
  for (int i = 0; i < texts; ++i) {
    for (const std::string& emotion : emotions) {
      CorpusSentence sentence;
      sentence.id = fmt::format("u{}", i);
      sentence.speaker = "ann";
      sentence.emotion = emotion;
      corpus.sentences.push_back(sentence);
    }
  }
  return corpus;
}

std::set<std::string> texts_of(const std::set<std::string>& keys) {
  std::set<std::string> texts;
  for (const std::string& key : keys) {
    texts.insert(key.substr(key.rfind('/')));
  }
  return texts;
}

bool share_any(const std::set<std::string>& some, const std::set<std::string>& others) {
  return std::ranges::any_of(some, [&](const std::string& key) { return others.contains(key); });
}

TEST(TuneSets, NoSetKnowsAnythingOfTheFoldThatItIsTunedWithout) {
  const Corpus corpus = made_corpus(40, {"anger", "neutral"});
  const std::vector<int> fold_of = assign_folds(corpus, kLots.folds, kLots.seed);
  std::map<int, std::set<std::string>> folds;
  for (std::size_t i = 0; i < fold_of.size(); ++i) {
    folds[fold_of[i]].insert(sentence_key(corpus.sentences[i]));
  }
  const std::vector<TuneSetPlan> plans = plan_tune_sets(corpus, kLots);
  ASSERT_EQ(plans.size(), 9u);
  int inner = 0;
  for (const TuneSetPlan& plan : plans) {
    std::size_t spoken = 0;
    for (const TunePart& part : plan.parts) {
      EXPECT_FALSE(part.spoken.empty());
      EXPECT_FALSE(share_any(texts_of(part.spoken), texts_of(part.training))) << plan.name;
      spoken += part.spoken.size();
      if (plan.inner && plan.fold > 0) {
        EXPECT_FALSE(share_any(part.training, folds[plan.fold])) << plan.name;
        EXPECT_FALSE(share_any(part.spoken, folds[plan.fold])) << plan.name;
      }
      if (!plan.inner) { // the whole fold is spoken, with all the others
        EXPECT_EQ(part.spoken, folds[plan.fold]);
        EXPECT_EQ(part.training.size() + part.spoken.size(), corpus.sentences.size());
      }
    }
    if (plan.inner) {
      ++inner;
      EXPECT_EQ(plan.parts.size(), 3u);
      EXPECT_EQ(spoken, 8u);
    }
  }
  EXPECT_EQ(inner, 5);
}

TEST(TuneSets, ASetHearsOtherSentencesThanTheNext) {
  const std::vector<TuneSetPlan> plans = plan_tune_sets(made_corpus(200, {"neutral"}), kLots);
  EXPECT_NE(plans[0].parts[0].spoken, plans[1].parts[0].spoken);
  EXPECT_NE(plans[0].name, plans[1].name);
  const std::vector<TuneSetPlan> again = plan_tune_sets(made_corpus(200, {"neutral"}), kLots);
  EXPECT_EQ(plans[0].parts[0].spoken, again[0].parts[0].spoken);
}

TEST(TuneSets, AtMostSoManyHeldOutSentencesAreSpoken) {
  TuneLots lots = kLots;
  lots.held_out = 5;
  const std::vector<TuneSetPlan> plans = plan_tune_sets(made_corpus(60, {"neutral"}), lots);
  EXPECT_EQ(plans.back().parts.front().spoken.size(), 5u);
  EXPECT_EQ(plans.back().parts.front().training.size(), 45u);
}

TEST(TuneSets, TooFewSentencesForTheInnerFoldsAreRefused) {
  EXPECT_THROW(plan_tune_sets(made_corpus(3, {"neutral"}), kLots), InputError);
  EXPECT_THROW(
      plan_tune_sets(made_corpus(4, {"neutral"}), {.folds = 2, .inner = 3, .sentences = 3}),
      InputError);
}

} // namespace
} // namespace phonomime
