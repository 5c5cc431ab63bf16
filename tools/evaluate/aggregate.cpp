// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/aggregate.h"

#include "db/types/errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace phonomime {

namespace {

// Sentences and their folds in order of key.
void sort_sentences(MethodResult& method) {
  std::vector<std::size_t> order(method.sentences.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return method.sentences[i].key; });
  std::vector<SentenceMeasures> sentences;
  std::vector<int> folds;
  for (const std::size_t i : order) {
    sentences.push_back(std::move(method.sentences[i]));
    if (!method.folds.empty()) {
      folds.push_back(method.folds.at(i));
    }
  }
  method.sentences = std::move(sentences);
  method.folds = std::move(folds);
}

void check_same_sentences(const Evaluation& evaluation) {
  const MethodResult& first = evaluation.methods.front();
  for (const MethodResult& method : evaluation.methods) {
    if (!std::ranges::equal(method.sentences, first.sentences, {}, &SentenceMeasures::key,
                            &SentenceMeasures::key) ||
        method.folds != first.folds) {
      throw InternalError({.what = "two methods were evaluated on other sentences",
                           .expected = "those of " + first.id,
                           .got = "those of " + method.id});
    }
  }
}

std::array<Summary, kMeasureCount>
summarise_some(const std::vector<const SentenceMeasures*>& some) {
  std::array<Summary, kMeasureCount> summaries = {};
  MeasureSums pooled;
  std::vector<MeasureValues> values;
  for (const SentenceMeasures* sentence : some) {
    pooled.add(sentence->sums);
    values.push_back(measure_values(sentence->sums));
  }
  const MeasureValues of_all = measure_values(pooled);
  for (const Measure measure : all_measures()) {
    Summary& summary = summaries[static_cast<std::size_t>(measure)];
    summary.pooled = of_all[measure];
    PairMoments moments;
    for (const MeasureValues& sentence : values) {
      if (sentence[measure]) {
        moments.add(*sentence[measure], *sentence[measure]);
      }
    }
    summary.sentences = moments.count;
    if (moments.count > 0) {
      summary.mean = moments.mean_recorded;
    }
    summary.standard_error = moments.recorded_mean_error();
  }
  return summaries;
}

// Summaries of the sentences that share a name: an emotion, a fold.
template <typename Key, typename KeyOf>
std::map<Key, std::array<Summary, kMeasureCount>> summarise_by(const MethodResult& method,
                                                               KeyOf key_of) {
  std::map<Key, std::vector<const SentenceMeasures*>> parts;
  for (std::size_t i = 0; i < method.sentences.size(); ++i) {
    parts[key_of(i)].push_back(&method.sentences[i]);
  }
  std::map<Key, std::array<Summary, kMeasureCount>> summaries;
  for (const auto& [key, some] : parts) {
    summaries[key] = summarise_some(some);
  }
  return summaries;
}

void fill_groups(const Layout& layout, const MeasureSums& pooled, MethodTables& tables) {
  const auto frames = static_cast<double>(pooled.frames);
  tables.marker_rmse.assign(layout.groups.size(), std::nullopt);
  if (pooled.frames == 0) {
    return;
  }
  for (std::size_t g = 0; g < pooled.group_error_sq.size(); ++g) {
    tables.marker_rmse.at(g) = std::sqrt(pooled.group_error_sq[g] / frames);
  }
  for (std::size_t r = 0; r < kRegionNames.size(); ++r) {
    const std::vector<int> groups = layout.groups_in(static_cast<Region>(r));
    double sum = 0.0;
    for (const int group : groups) {
      sum += pooled.group_error_sq.at(static_cast<std::size_t>(group));
    }
    if (!groups.empty()) {
      tables.region_rmse[r] = std::sqrt(sum / frames / static_cast<double>(groups.size()));
    }
  }
}

MethodTables fill_tables(const Layout& layout, const MethodResult& method) {
  MethodTables tables;
  tables.all = summarise(method.sentences);
  MeasureSums pooled;
  std::map<std::string, MeasureSums> phonemes;
  for (const SentenceMeasures& sentence : method.sentences) {
    tables.sentences.push_back(measure_values(sentence.sums));
    tables.total_error += tables.sentences.back()[Measure::squared_error].value_or(0.0);
    pooled.add(sentence.sums);
    for (const auto& [phoneme, sums] : sentence.phoneme_sums) {
      phonemes[phoneme].add(sums);
    }
  }
  for (const auto& [phoneme, sums] : phonemes) {
    tables.by_phoneme[phoneme] = measure_values(sums);
    tables.phoneme_frames[phoneme] = sums.frames;
  }
  fill_groups(layout, pooled, tables);
  tables.by_emotion =
      summarise_by<std::string>(method, [&](std::size_t i) { return method.sentences[i].emotion; });
  if (!method.folds.empty()) {
    tables.by_fold = summarise_by<int>(method, [&](std::size_t i) { return method.folds[i]; });
  }
  return tables;
}

} // namespace

void judge_contacts(std::span<SentenceMeasures> sentences,
                    const std::map<std::string, ContactRange>& ranges) {
  for (SentenceMeasures& sentence : sentences) {
    const auto reset = [](MeasureSums& sums) { sums.contact = sums.contact_recorded = {}; };
    reset(sentence.sums);
    for (auto& [phoneme, sums] : sentence.phoneme_sums) {
      reset(sums);
    }
    for (const LipEvent& event : sentence.lip_events) {
      const auto range = ranges.find(event.phoneme);
      if (event.demand != LipDemand::contact || range == ranges.end()) {
        continue;
      }
      for (MeasureSums* sums : {&sentence.sums, &sentence.phoneme_sums[event.phoneme]}) {
        sums->contact.add(range->second.holds(event.synthesised_aperture_mm) ? 1.0 : 0.0);
        sums->contact_recorded.add(range->second.holds(event.recorded_aperture_mm) ? 1.0 : 0.0);
      }
    }
  }
}

std::map<std::string, ContactRange>
recorded_contact_ranges(std::span<const SentenceMeasures> sentences) {
  std::vector<LipEvent> events;
  for (const SentenceMeasures& sentence : sentences) {
    events.insert(events.end(), sentence.lip_events.begin(), sentence.lip_events.end());
  }
  return contact_ranges(events);
}

void aggregate(Evaluation& evaluation) {
  if (evaluation.methods.empty() || evaluation.methods.front().sentences.empty()) {
    throw InputError({.where = evaluation.run.corpus, .what = "there is no sentence to evaluate"});
  }
  for (MethodResult& method : evaluation.methods) {
    sort_sentences(method);
  }
  check_same_sentences(evaluation);
  evaluation.contact_ranges = recorded_contact_ranges(evaluation.methods.front().sentences);
  evaluation.tables.clear();
  for (MethodResult& method : evaluation.methods) {
    judge_contacts(method.sentences, evaluation.contact_ranges);
    evaluation.tables.push_back(fill_tables(evaluation.layout, method));
  }
}

std::array<Summary, kMeasureCount> summarise(std::span<const SentenceMeasures> sentences) {
  std::vector<const SentenceMeasures*> all;
  for (const SentenceMeasures& sentence : sentences) {
    all.push_back(&sentence);
  }
  return summarise_some(all);
}

std::size_t main_method_index(const Evaluation& evaluation) {
  if (evaluation.main_method.empty() && !evaluation.methods.empty()) {
    return 0;
  }
  const auto found =
      std::ranges::find(evaluation.methods, evaluation.main_method, &MethodResult::id);
  if (found == evaluation.methods.end()) {
    throw InternalError(
        {.what = "the main method was not evaluated", .got = evaluation.main_method});
  }
  return static_cast<std::size_t>(found - evaluation.methods.begin());
}

} // namespace phonomime
