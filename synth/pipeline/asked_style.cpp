// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/asked_style.h"

#include "synth/style/mixture.h"
#include "synth/style/style_model.h"

#include <algorithm>

namespace phonomime {

namespace {

Eigen::VectorXd weights_of(const StyleModel& model, const EmotionMixture& mixture) {
  std::vector<EmotionModifier> parts = mixture.others;
  parts.push_back(mixture.heaviest);
  return mixture_weights(model.known.styles, model.neutral, parts);
}

} // namespace

EmotionMixture asked_at(const StyleInput& input, double time_s) {
  const auto span = std::ranges::upper_bound(input.track.spans, time_s, {}, &EmotionSpan::end_s);
  return span != input.track.spans.end() && span->start_s <= time_s ? mixture_of(*span)
                                                                    : input.fallback;
}

Eigen::MatrixXd asked_weights(const StyleInput& input, double rate_hz, Eigen::Index frames) {
  Eigen::MatrixXd weights(static_cast<Eigen::Index>(input.model->known.styles.size()), frames);
  EmotionMixture last;
  for (Eigen::Index k = 0; k < frames; ++k) {
    EmotionMixture asked = asked_at(input, static_cast<double>(k) / rate_hz);
    if (k > 0 && asked == last) {
      weights.col(k) = weights.col(k - 1);
    } else {
      weights.col(k) = weights_of(*input.model, asked);
      last = std::move(asked);
    }
  }
  return weights;
}

void fill_silent_styles(const StyleModel& model, const std::vector<bool>& is_shown, double rate_hz,
                        const SilenceOptions& silence, Eigen::MatrixXd& shown,
                        Eigen::MatrixXd& wanted) {
  const auto frames = static_cast<Eigen::Index>(is_shown.size());
  const Eigen::VectorXd neutral = mixture_weights(model.known.styles, model.neutral, {});
  const auto shows = [&](Eigen::Index k) { return is_shown[static_cast<std::size_t>(k)]; };
  for (Eigen::Index first = 0; first < frames; ++first) {
    if (shows(first)) {
      continue;
    }
    Eigen::Index end = first;
    while (end < frames && !shows(end)) {
      ++end;
    }
    for (Eigen::Index k = first; k < end; ++k) {
      if (first > 0 && end < frames) {
        const double share =
            static_cast<double>(k - first + 1) / static_cast<double>(end - first + 1);
        shown.col(k) = shown.col(first - 1) + share * (shown.col(end) - shown.col(first - 1));
      } else if (first == 0 && end == frames) {
        shown.col(k) = wanted.col(k) = neutral;
      } else {
        const Eigen::Index border = first > 0 ? first - 1 : end;
        const double away_s = static_cast<double>(std::abs(k - border)) / rate_hz;
        const double rest = !silence.rest_at_ends            ? 0.0
                            : away_s < silence.rest_within_s ? away_s / silence.rest_within_s
                                                             : 1.0;
        shown.col(k) = shown.col(border) + rest * (neutral - shown.col(border));
        wanted.col(k) = wanted.col(border) + rest * (neutral - wanted.col(border));
      }
    }
    first = end;
  }
}

} // namespace phonomime
