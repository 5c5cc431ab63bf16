// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/evaluate_sizes.h"

#include "db/types/sentence_key.h"
#include "tools/app/folds.h"
#include "tools/app/speak_held_out.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <utility>

namespace phonomime {

namespace {

// The one in `part` of the sentences with the smallest lots, at least one.
std::vector<bool> draw_sentences(const MotionTable& table, std::size_t part, std::uint64_t seed) {
  std::vector<std::pair<std::uint64_t, std::size_t>> lots;
  for (std::size_t s = 0; s < table.sentences.size(); ++s) {
    lots.emplace_back(lot_of(sentence_key(table.sentences[s]), seed), s);
  }
  std::ranges::sort(lots);
  std::vector<bool> drawn(lots.size(), false);
  for (std::size_t i = 0; i < std::max<std::size_t>(1, lots.size() / part); ++i) {
    drawn[lots[i].second] = true;
  }
  return drawn;
}

std::vector<ImportedSentence> sentences_of(const std::vector<ImportedSentence>& sentences,
                                           const std::string& speaker) {
  std::vector<ImportedSentence> found;
  std::ranges::copy_if(sentences, std::back_inserter(found), [&](const ImportedSentence& sentence) {
    return sentence.speaker == speaker;
  });
  return found;
}

double share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

} // namespace

void SizeStudy::add(const HeldOut& held_out, const SynthOptions& options,
                    const Progress& progress) {
  ++folds_;
  for (std::size_t p = 0; p < kParts.size(); ++p) {
    Part& part = parts_[p];
    std::map<std::string, MotionTable> tables;
    for (const auto& [speaker, table] : held_out.tables) {
      const auto one_in = static_cast<std::size_t>(kParts[p]);
      const auto [added, is_new] =
          tables.emplace(speaker, part_of(table, draw_sentences(table, one_in, seed_)));
      part.sentences += static_cast<std::int64_t>(added->second.sentences.size());
      part.nodes += added->second.node_count();
      part.coverage.add(context_coverage(added->second, sentences_of(held_out.sentences, speaker)));
    }
    speak_held_out(tables, held_out.sentences, std::span(&method_, 1), options, progress,
                   [&](std::size_t, SpokenSentence&& spoken) {
                     part.measures.push_back(std::move(spoken.measures.front()));
                     part.search_s += spoken.search_s.front();
                   });
  }
}

std::vector<SizePoint> SizeStudy::points() {
  std::vector<SizePoint> points;
  for (Part& part : parts_) {
    if (part.measures.empty()) {
      continue;
    }
    std::ranges::sort(part.measures, {}, &SentenceMeasures::key);
    judge_contacts(part.measures, recorded_contact_ranges(part.measures));
    points.push_back(
        {.sentences = part.sentences / folds_,
         .nodes = part.nodes / folds_,
         .diphone_coverage = share(part.coverage.diphones_recorded, part.coverage.diphones),
         .triphone_coverage = share(part.coverage.triphones_recorded, part.coverage.triphones),
         .search_s = part.search_s / static_cast<double>(part.measures.size()),
         .quality = summarise(part.measures)});
  }
  return points;
}

} // namespace phonomime
