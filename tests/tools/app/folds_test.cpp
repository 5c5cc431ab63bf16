// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/folds.h"

#include "db/types/errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

namespace phonomime {
namespace {

Corpus corpus_of(int texts, std::vector<std::string> emotions) {
  Corpus corpus;
  for (const std::string& emotion : emotions) {
    for (int i = 0; i < texts; ++i) {
      corpus.sentences.push_back(
          {.id = fmt::format("u{:03}", i), .speaker = "ann", .emotion = emotion});
    }
  }
  return corpus;
}

std::map<std::string, int> folds_by_key(const Corpus& corpus, int folds, std::uint64_t seed) {
  const std::vector<int> fold_of = assign_folds(corpus, folds, seed);
  std::map<std::string, int> by_key;
  for (std::size_t i = 0; i < fold_of.size(); ++i) {
    by_key[corpus.sentences[i].emotion + "/" + corpus.sentences[i].id] = fold_of[i];
  }
  return by_key;
}

TEST(Folds, HoldEachSentenceOutOnceInPartsOfNearlyTheSameSize) {
  const Corpus corpus = corpus_of(803, {"neutral"});
  std::map<int, int> sizes;
  for (const int fold : assign_folds(corpus, 5, 1)) {
    ++sizes[fold];
  }
  EXPECT_EQ(sizes, (std::map<int, int>{{1, 161}, {2, 161}, {3, 161}, {4, 160}, {5, 160}}));
}

TEST(Folds, KeepATextTogetherInAllItsEmotions) {
  const Corpus corpus = corpus_of(40, {"neutral", "happiness", "anger"});
  const std::map<std::string, int> folds = folds_by_key(corpus, 4, 9);
  std::set<int> used;
  for (int i = 0; i < 40; ++i) {
    const std::string id = fmt::format("u{:03}", i);
    EXPECT_EQ(folds.at("neutral/" + id), folds.at("happiness/" + id));
    EXPECT_EQ(folds.at("neutral/" + id), folds.at("anger/" + id));
    used.insert(folds.at("neutral/" + id));
  }
  EXPECT_EQ(used.size(), 4u);
}

TEST(Folds, DependOnKeysAndSeedAndOnNothingElse) {
  const Corpus corpus = corpus_of(100, {"neutral"});
  Corpus reversed = corpus;
  std::ranges::reverse(reversed.sentences);
  reversed.name = "other";
  EXPECT_EQ(folds_by_key(corpus, 5, 1), folds_by_key(reversed, 5, 1));
  EXPECT_NE(folds_by_key(corpus, 5, 1), folds_by_key(corpus, 5, 2));
  // Not in the order of the table.
  const std::vector<int> fold_of = assign_folds(corpus, 5, 1);
  EXPECT_FALSE(std::ranges::is_sorted(fold_of));
}

TEST(Folds, AreTheSameOnEveryMachine) {
  // FNV-1a of "a" by its published value, then SplitMix64 written out.
  std::uint64_t lot = 0xaf63dc4c8601ec8cu + 2 * 0x9e3779b97f4a7c15u;
  lot = (lot ^ (lot >> 30)) * 0xbf58476d1ce4e5b9u;
  lot = (lot ^ (lot >> 27)) * 0x94d049bb133111ebu;
  EXPECT_EQ(lot_of("a", 1), lot ^ (lot >> 31));
}

TEST(Folds, NeedAsManyTexts) {
  const Corpus corpus = corpus_of(3, {"neutral", "anger"});
  EXPECT_NO_THROW(assign_folds(corpus, 3, 1));
  EXPECT_THROW(assign_folds(corpus, 4, 1), InputError);
}

} // namespace
} // namespace phonomime
