// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tune/tuning.h"

#include "tools/evaluate/measure_sums.h"
#include "tools/evaluate/paired_test.h"

#include <cmath>

namespace phonomime {

namespace {

constexpr double kSignificance = 0.05;

void append(Scores& all, const Scores& some) {
  all.keys.insert(all.keys.end(), some.keys.begin(), some.keys.end());
  all.shipped.insert(all.shipped.end(), some.shipped.begin(), some.shipped.end());
  all.tuned.insert(all.tuned.end(), some.tuned.begin(), some.tuned.end());
}

} // namespace

Gain gain_of(const Scores& scores, Measure objective) {
  Gain gain;
  Tally shipped, tuned;
  PairMoments moments;
  std::vector<double> differences;
  for (std::size_t i = 0; i < scores.keys.size(); ++i) {
    if (!scores.shipped[i] || !scores.tuned[i]) {
      continue;
    }
    shipped.add(*scores.shipped[i]);
    tuned.add(*scores.tuned[i]);
    const double difference =
        *badness(objective, *scores.shipped[i]) - *badness(objective, *scores.tuned[i]);
    differences.push_back(difference);
    moments.add(difference, difference);
    gain.better += difference > 0.0 ? 1 : 0;
    gain.worse += difference < 0.0 ? 1 : 0;
  }
  gain.sentences = moments.count;
  gain.shipped = shipped.mean();
  gain.tuned = tuned.mean();
  if (moments.count > 0) {
    gain.gain = moments.mean_recorded;
  }
  gain.standard_error = moments.recorded_mean_error();
  gain.p_value = signed_rank_test(differences).p_value;
  return gain;
}

Scores held_out_scores(const Tuning& tuning) {
  Scores all;
  for (const TunedPart& fold : tuning.folds) {
    append(all, fold.held_out);
  }
  return all;
}

Scores inner_scores(const Tuning& tuning) {
  Scores all;
  for (const TunedPart& fold : tuning.folds) {
    append(all, fold.inner);
  }
  return all;
}

TuningVerdict verdict_of(const Tuning& tuning) {
  const Gain gain = gain_of(held_out_scores(tuning), tuning.objective);
  if (!gain.gain || gain.p_value >= kSignificance || *gain.gain == 0.0) {
    return TuningVerdict::no_difference;
  }
  return *gain.gain > 0.0 ? TuningVerdict::better : TuningVerdict::worse;
}

std::string_view verdict_sentence(TuningVerdict verdict) {
  switch (verdict) {
  case TuningVerdict::better:
    return "On sentences that it does not see, such a tuning is better than the shipped weights.";
  case TuningVerdict::worse:
    return "On sentences that it does not see, such a tuning is worse than the shipped weights: "
           "keep those.";
  case TuningVerdict::no_difference:
    break;
  }
  return "Sentences that it does not see show no difference to the shipped weights: there is no "
         "reason to leave those.";
}

std::optional<double> mean_of(const SentenceValues& values) {
  Tally tally;
  for (const std::optional<double>& value : values) {
    if (value) {
      tally.add(*value);
    }
  }
  return tally.mean();
}

} // namespace phonomime
