// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/tune_sets.h"

#include "db/types/sentence_key.h"
#include "synth/search/cost_weights.h"
#include "tools/app/folds.h"
#include "tools/app/held_out.h"
#include "tools/app/temporary_folder.h"
#include "tools/evaluate/measures.h"
#include "tools/evaluate/methods.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

// The sentences of a corpus that are not of `fold`.
Corpus without_fold(const Corpus& corpus, const std::vector<int>& fold_of, int fold) {
  Corpus rest = corpus;
  rest.reference_frames.clear(); // they point into the sentences; plans look at keys alone
  rest.sentences.clear();
  for (std::size_t i = 0; i < corpus.sentences.size(); ++i) {
    if (fold_of[i] != fold) {
      rest.sentences.push_back(corpus.sentences[i]);
    }
  }
  return rest;
}

// Of a fold the `count` first sentences by lot, and all that are in other folds.
TunePart part_of_fold(const Corpus& corpus, const std::vector<int>& fold_of, int fold,
                      std::size_t count, std::uint64_t seed) {
  TunePart part;
  for (const std::size_t i : in_order_of_lots(corpus.sentences, seed)) {
    if (fold_of[i] != fold) {
      part.training.insert(sentence_key(corpus.sentences[i]));
    } else if (part.spoken.size() < count) {
      part.spoken.insert(sentence_key(corpus.sentences[i]));
    }
  }
  return part;
}

TuneSetPlan inner_set(const Corpus& rest, const TuneLots& lots, int fold) {
  TuneSetPlan plan{.name = fold > 0 ? fmt::format("without fold {}", fold) : "all", .fold = fold};
  // Lots of their own: else each tuning would hear much the same sentences.
  const std::uint64_t seed = lots.seed + static_cast<std::uint64_t>(fold);
  const std::vector<int> fold_of = assign_folds(rest, lots.inner, seed);
  for (int inner = 1; inner <= lots.inner; ++inner) {
    const int count = lots.sentences / lots.inner + (inner <= lots.sentences % lots.inner ? 1 : 0);
    plan.parts.push_back(part_of_fold(rest, fold_of, inner, static_cast<std::size_t>(count), seed));
  }
  return plan;
}

} // namespace

std::vector<TuneSetPlan> plan_tune_sets(const Corpus& corpus, const TuneLots& lots) {
  const std::vector<int> fold_of = assign_folds(corpus, lots.folds, lots.seed);
  std::vector<TuneSetPlan> plans;
  for (int fold = 1; fold <= lots.folds; ++fold) {
    plans.push_back(inner_set(without_fold(corpus, fold_of, fold), lots, fold));
  }
  plans.push_back(inner_set(corpus, lots, 0));
  const std::size_t count = lots.held_out > 0 ? static_cast<std::size_t>(lots.held_out)
                                              : std::numeric_limits<std::size_t>::max();
  for (int fold = 1; fold <= lots.folds; ++fold) {
    plans.push_back({.name = fmt::format("fold {}", fold),
                     .fold = fold,
                     .inner = false,
                     .parts = {part_of_fold(corpus, fold_of, fold, count, lots.seed)}});
  }
  return plans;
}

TuneSet::TuneSet(const TuneSetPlan& plan, const ImportOptions& import, const TuneMethod& method,
                 const Progress& progress)
    : name_(plan.name), method_(method) {
  for (const TunePart& part : plan.parts) {
    const TemporaryFolder folder;
    HeldOut held_out = hold_out(
        import,
        [&](const CorpusSentence& sentence) {
          return !part.training.contains(sentence_key(sentence));
        },
        [&](const CorpusSentence& sentence) {
          return part.spoken.contains(sentence_key(sentence));
        },
        folder.path() / "part.db", progress);
    notes_.insert(notes_.end(), held_out.notes.begin(), held_out.notes.end());
    Part& kept = parts_.emplace_back();
    kept.tables = std::move(held_out.tables);
    kept.sentences = std::move(held_out.sentences);
    for (const auto& [speaker, table] : kept.tables) {
      kept.pnt[speaker] = default_cost_weights(table, method.cost).pnt;
    }
  }
}

std::vector<std::string> TuneSet::keys() const {
  std::vector<std::string> keys;
  for (const Part& part : parts_) {
    for (const ImportedSentence& sentence : part.sentences) {
      keys.push_back(sentence_key(sentence));
    }
  }
  return keys;
}

CostWeights TuneSet::shipped() const {
  CostWeights weights = default_cost_weights(parts_.front().tables.begin()->second, method_.cost);
  weights.pnt = 0.0;
  return weights;
}

SentenceValues TuneSet::speak(const CostWeights& weights, const Progress& progress) const {
  SentenceValues values;
  for (const Part& part : parts_) {
    std::map<std::string, std::unique_ptr<Method>> methods;
    for (const auto& [speaker, table] : part.tables) {
      MethodContext context{.table = table, .weights = weights};
      context.weights.pnt = part.pnt.at(speaker);
      context.blend = method_.blend;
      context.concat = method_.concat;
      methods[speaker] = make_default(context, progress);
    }
    for (const ImportedSentence& sentence : part.sentences) {
      const MotionTable& table = part.tables.at(sentence.speaker);
      const SentenceRequest request{.rows = sentence.rows,
                                    .emotion = sentence.emotion,
                                    .frame_count = sentence.channels.rows()};
      const MethodAnswer answer = methods.at(sentence.speaker)->say(request, 0, progress);
      const MeasureSetup setup{
          .layout = table.layout, .rate_hz = table.rate_hz, .reference_pose = table.reference_pose};
      const SentenceMeasures measures =
          measure_sentence(setup, sentence, answer.sentence.channels, answer.sentence.joins);
      values.push_back(measure_values(measures.sums)[method_.objective]);
    }
  }
  return values;
}

} // namespace phonomime
