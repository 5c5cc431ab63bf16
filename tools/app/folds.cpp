// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/folds.h"

#include "db/types/errors.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

namespace phonomime {

namespace {

// What stays together: the key without its emotion.
std::string spoken_text(const CorpusSentence& sentence) {
  return sentence.speaker + "/" + sentence.id;
}

} // namespace

std::uint64_t lot_of(std::string_view text, std::uint64_t seed) {
  std::uint64_t lot = 0xcbf29ce484222325u; // FNV-1a
  for (const char c : text) {
    lot = (lot ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  }
  lot += (seed + 1) * 0x9e3779b97f4a7c15u; // SplitMix64
  lot = (lot ^ (lot >> 30)) * 0xbf58476d1ce4e5b9u;
  lot = (lot ^ (lot >> 27)) * 0x94d049bb133111ebu;
  return lot ^ (lot >> 31);
}

std::vector<std::size_t> in_order_of_lots(std::span<const CorpusSentence> sentences,
                                          std::uint64_t seed) {
  std::vector<std::tuple<std::uint64_t, std::string, std::string>> lots;
  for (const CorpusSentence& sentence : sentences) {
    const std::string text = spoken_text(sentence);
    lots.emplace_back(lot_of(text, seed), text, sentence.emotion);
  }
  std::vector<std::size_t> order(sentences.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return lots[i]; });
  return order;
}

std::vector<int> assign_folds(const Corpus& corpus, int folds, std::uint64_t seed) {
  std::vector<int> fold_of(corpus.sentences.size(), 0);
  std::string before;
  int texts = 0;
  for (const std::size_t i : in_order_of_lots(corpus.sentences, seed)) {
    const std::string text = spoken_text(corpus.sentences[i]);
    if (texts == 0 || text != before) {
      before = text;
      ++texts;
    }
    fold_of[i] = (texts - 1) % folds + 1;
  }
  if (texts < folds) {
    throw InputError(
        {.where = corpus.folder.string(),
         .what = "the corpus has fewer sentences than there are to be folds",
         .expected = fmt::format("at least {} (a sentence in several emotions is one)", folds),
         .got = fmt::format("{}", texts)});
  }
  return fold_of;
}

} // namespace phonomime
