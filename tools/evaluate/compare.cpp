// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/compare.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "tools/evaluate/paired_test.h"

#include <algorithm>

#include <fmt/format.h>

namespace phonomime {

namespace {

[[noreturn]] void refuse(const EarlierRun& earlier, std::string what, std::string expected,
                         std::string got) {
  throw InputError({.where = earlier.source,
                    .what = std::move(what),
                    .expected = std::move(expected),
                    .got = std::move(got),
                    .remedy = "Compare with a report of the same corpus."});
}

// A sentence of both runs.
struct SentencePair {
  const MeasureValues* now = nullptr;
  const MeasureValues* earlier = nullptr;
};

std::vector<SentencePair> pair_sentences(const Evaluation& evaluation, std::size_t method,
                                         const EarlierRun& run, const EarlierRun::Method& earlier) {
  std::vector<SentencePair> pairs;
  const std::vector<SentenceMeasures>& sentences = evaluation.methods[method].sentences;
  for (std::size_t i = 0; i < sentences.size(); ++i) {
    const auto found = std::ranges::lower_bound(earlier.sentences, sentences[i].key, {},
                                                &EarlierRun::Sentence::key);
    if (found == earlier.sentences.end() || found->key != sentences[i].key) {
      continue;
    }
    if (found->frame_count != sentences[i].frame_count) {
      refuse(run, fmt::format("sentence {} is another recording there", found->key),
             fmt::format("{} frames", sentences[i].frame_count),
             std::to_string(found->frame_count));
    }
    pairs.push_back({&evaluation.tables[method].sentences[i], &found->values});
  }
  return pairs;
}

MeasureComparison compare_measure(Measure measure, const std::vector<SentencePair>& pairs) {
  MeasureComparison comparison;
  comparison.measure = measure;
  Tally now, earlier;
  std::vector<double> differences; // of badness
  for (const SentencePair& pair : pairs) {
    const auto& value = (*pair.now)[measure];
    const auto& earlier_value = (*pair.earlier)[measure];
    if (!value || !earlier_value) {
      continue;
    }
    now.add(*value);
    earlier.add(*earlier_value);
    if (const auto bad = badness(measure, *value)) {
      const double difference = *bad - *badness(measure, *earlier_value);
      differences.push_back(difference);
      comparison.better += difference < 0.0 ? 1 : 0;
      comparison.worse += difference > 0.0 ? 1 : 0;
    }
  }
  comparison.sentences = now.count;
  comparison.mean = now.mean().value_or(0.0);
  comparison.earlier_mean = earlier.mean().value_or(0.0);
  comparison.difference = comparison.mean - comparison.earlier_mean;
  if (!differences.empty()) {
    const SignedRanks ranks = signed_rank_test(differences);
    comparison.p_value = ranks.p_value;
    comparison.verdict = ranks.positive < ranks.negative ? Verdict::better : Verdict::worse;
  }
  return comparison;
}

// Turns the directions of compare_measure into verdicts.
void judge(std::vector<MeasureComparison>& measures) {
  std::vector<double> p_values;
  for (const MeasureComparison& comparison : measures) {
    if (comparison.verdict != Verdict::not_compared) {
      p_values.push_back(comparison.p_value);
    }
  }
  const std::vector<double> adjusted = holm_adjusted(p_values);
  std::size_t next = 0;
  for (MeasureComparison& comparison : measures) {
    if (comparison.verdict == Verdict::not_compared) {
      continue;
    }
    comparison.adjusted_p = adjusted[next++];
    if (!(comparison.adjusted_p < kSignificance)) {
      comparison.verdict = Verdict::no_difference;
    }
  }
}

const EarlierRun::Method* find_method(const EarlierRun& run, const std::string& id) {
  const auto found = std::ranges::find(run.methods, id, &EarlierRun::Method::id);
  return found == run.methods.end() ? nullptr : &*found;
}

// The earlier method that one is compared with: its namesake, or the main one with the main one.
const EarlierRun::Method* counterpart(const Evaluation& evaluation, std::size_t method,
                                      const EarlierRun& run) {
  if (const auto* namesake = find_method(run, evaluation.methods[method].id)) {
    return namesake;
  }
  return method == main_method_index(evaluation) ? find_method(run, run.main_method) : nullptr;
}

std::vector<std::string> differences_of_runs(const Evaluation& evaluation,
                                             const EarlierRun& earlier) {
  std::vector<std::string> notes;
  if (evaluation.run.held_out_by != earlier.held_out_by) {
    notes.push_back(
        fmt::format("The earlier run was held out otherwise: {}.", earlier.held_out_by));
  }
  const auto count = [](std::size_t sentences) { return static_cast<std::int64_t>(sentences); };
  for (const Measure measure : all_measures()) {
    if (std::ranges::find(earlier.measures, measure) == earlier.measures.end()) {
      notes.push_back(fmt::format("The earlier run has no {}.", info(measure).label));
    }
  }
  const std::int64_t ours = count(evaluation.methods.front().sentences.size());
  const std::int64_t theirs = count(earlier.methods.front().sentences.size());
  if (ours != theirs) {
    notes.push_back(fmt::format("The earlier run has {} sentences, this one {}.", theirs, ours));
  }
  return notes;
}

} // namespace

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
  case Verdict::better:
    return "better";
  case Verdict::worse:
    return "worse";
  case Verdict::no_difference:
    return "no difference";
  case Verdict::not_compared:
    break;
  }
  return "";
}

Comparison compare_runs(const Evaluation& evaluation, const EarlierRun& earlier) {
  if (evaluation.run.corpus != earlier.corpus) {
    refuse(earlier, "the report is of another corpus", quoted(evaluation.run.corpus),
           quoted(earlier.corpus));
  }
  if (evaluation.run.rate_hz != earlier.rate_hz) {
    refuse(earlier, "the report is of another rate", format_number(evaluation.run.rate_hz) + " Hz",
           format_number(earlier.rate_hz));
  }
  Comparison comparison;
  comparison.source = earlier.source;
  comparison.earlier_held_out_by = earlier.held_out_by;
  for (std::size_t m = 0; m < evaluation.methods.size(); ++m) {
    const EarlierRun::Method* other = counterpart(evaluation, m, earlier);
    if (other == nullptr) {
      continue;
    }
    const std::vector<SentencePair> pairs = pair_sentences(evaluation, m, earlier, *other);
    if (pairs.empty()) {
      refuse(earlier, "the report has no sentence in common with this run",
             fmt::format("some of {} sentences", evaluation.methods[m].sentences.size()), "none");
    }
    MethodComparison method = {.method = evaluation.methods[m].id,
                               .earlier_method = other->id,
                               .sentences = static_cast<std::int64_t>(pairs.size())};
    for (const Measure measure : earlier.measures) {
      MeasureComparison one = compare_measure(measure, pairs);
      if (one.sentences > 0) {
        method.measures.push_back(one);
      }
    }
    judge(method.measures);
    comparison.methods.push_back(std::move(method));
  }
  if (comparison.methods.empty()) {
    refuse(earlier, "the report has no method in common with this run",
           quoted(evaluation.methods[main_method_index(evaluation)].id),
           quoted(earlier.methods.empty() ? std::string() : earlier.methods.front().id));
  }
  comparison.notes = differences_of_runs(evaluation, earlier);
  return comparison;
}

} // namespace phonomime
