// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/emotion_track.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::string_view kLineForm = "start end emotion [intensity]";

double parse_intensity(std::string_view field, std::string_view where) {
  const std::optional<double> intensity = parse_number(field);
  if (!intensity || *intensity < 0.0 || *intensity > kLargestIntensity) {
    throw InputError({.where = std::string(where),
                      .what = "the intensity of an emotion is out of range",
                      .expected = fmt::format("a number from 0 to {}", kLargestIntensity),
                      .got = quoted(field),
                      .remedy = "1 is the emotion as it was recorded."});
  }
  return *intensity;
}

double parse_time(std::string_view field, std::string_view which, std::string_view where) {
  const std::optional<double> time = parse_number(field);
  if (!time || *time < 0.0) {
    throw InputError({.where = std::string(where),
                      .what = fmt::format("the {} of a span is not a time", which),
                      .expected = "seconds from 0 on, as in 1.25",
                      .got = quoted(field)});
  }
  return *time;
}

EmotionSpan parse_span(std::string_view line, std::string_view where) {
  const std::vector<std::string_view> words = split_words(line);
  if (words.size() < 3 || words.size() > 4) {
    throw InputError({.where = std::string(where),
                      .what = fmt::format("a line of an emotion track has {} words", words.size()),
                      .expected = std::string(kLineForm),
                      .got = quoted(line)});
  }
  EmotionSpan span{.start_s = parse_time(words[0], "start", where),
                   .end_s = parse_time(words[1], "end", where)};
  if (span.end_s <= span.start_s) {
    throw InputError({.where = std::string(where),
                      .what = "a span ends before it has begun",
                      .expected = "an end after the start",
                      .got = fmt::format("{} to {}", words[0], words[1]),
                      .remedy = span.end_s == span.start_s
                                    ? "Give the label a length: a point in time shows no emotion."
                                    : "Swap the two times."});
  }
  const bool mixed = words[2].find('+') != std::string_view::npos;
  const EmotionMixture mixture = parse_emotion_mixture(words[2], where);
  if (words.size() == 4 && (mixed || words[2].find(':') != std::string_view::npos)) {
    throw InputError({.where = std::string(where),
                      .what = "an intensity is given twice",
                      .expected = std::string(kLineForm),
                      .got = quoted(line)});
  }
  span.emotion = mixture.heaviest.emotion;
  span.intensity =
      words.size() == 4 ? parse_intensity(words[3], where) : mixture.heaviest.intensity;
  span.others = mixture.others;
  return span;
}

void require_no_overlap(const EmotionTrack& track) {
  for (std::size_t i = 1; i < track.spans.size(); ++i) {
    const EmotionSpan& before = track.spans[i - 1];
    const EmotionSpan& span = track.spans[i];
    if (span.start_s < before.end_s) {
      throw InputError(
          {.where = at_line(track.source, span.line),
           .what = fmt::format("{} overlaps line {}", quoted(span.emotion), before.line),
           .expected = fmt::format("a start of at least {} s", format_number(before.end_s)),
           .got = fmt::format("{} s", format_number(span.start_s)),
           .remedy = "Shorten one of the two: a moment has one emotion."});
    }
  }
}

// One emotion's share of a phoneme.
struct Share {
  std::string_view emotion;
  double overlap_s = 0.0;
  double longest_piece_s = 0.0;
  double intensity = 1.0;
};

// Sums of decimal times are compared with a tolerance, lest rounding break a tie.
constexpr double kTie_s = 1e-9;

// The pieces of a phoneme in order of time, silent ones too, gathered by emotion.
class Shares {
public:
  void add(std::string_view emotion, double intensity, double duration_s) {
    if (duration_s <= 0.0) {
      return;
    }
    auto share = std::ranges::find(shares_, emotion, &Share::emotion);
    if (share == shares_.end()) {
      share = shares_.insert(shares_.end(), {.emotion = emotion});
    }
    share->overlap_s += duration_s;
    if (duration_s > share->longest_piece_s + kTie_s) {
      share->longest_piece_s = duration_s;
      share->intensity = intensity;
    }
  }

  EmotionModifier heaviest(const EmotionModifier& fallback) const {
    const Share* best = nullptr;
    for (const Share& share : shares_) {
      if (best == nullptr || share.overlap_s > best->overlap_s + kTie_s) {
        best = &share;
      }
    }
    return best == nullptr ? fallback
                           : EmotionModifier{std::string(best->emotion), best->intensity};
  }

private:
  std::vector<Share> shares_; // in order of first appearance
};

} // namespace

EmotionModifier parse_emotion_modifier(std::string_view text, std::string_view where) {
  if (text.find('+') != std::string_view::npos) {
    throw InputError({.where = std::string(where),
                      .what = fmt::format("{} mixes emotions", quoted(text)),
                      .expected = "one emotion",
                      .remedy = "Mixtures are for --emotion and emotion tracks."});
  }
  const std::size_t colon = text.find(':');
  EmotionModifier modifier{.emotion = std::string(text.substr(0, colon))};
  if (modifier.emotion.empty() || modifier.emotion.find_first_of("/# \t") != std::string::npos) {
    throw InputError({.where = std::string(where),
                      .what = "an emotion has no usable name",
                      .expected = "a name without spaces, / and #",
                      .got = quoted(text)});
  }
  if (colon != std::string_view::npos) {
    modifier.intensity = parse_intensity(text.substr(colon + 1), where);
  }
  return modifier;
}

EmotionMixture parse_emotion_mixture(std::string_view text, std::string_view where) {
  std::vector<EmotionModifier> parts;
  double sum = 0.0;
  for (std::size_t first = 0; first <= text.size();) {
    const std::size_t end = std::min(text.find('+', first), text.size());
    parts.push_back(parse_emotion_modifier(text.substr(first, end - first), where));
    sum += parts.back().intensity;
    first = end + 1;
    if (std::ranges::count(parts, parts.back().emotion, &EmotionModifier::emotion) > 1) {
      throw InputError(
          {.where = std::string(where),
           .what = fmt::format("{} names {} twice", quoted(text), parts.back().emotion),
           .expected = "each emotion once"});
    }
  }
  if (sum > kLargestIntensity + 1e-9) {
    throw InputError(
        {.where = std::string(where),
         .what = fmt::format("the intensities of {} are too large together", quoted(text)),
         .expected = fmt::format("{} at most", kLargestIntensity),
         .got = format_number(sum),
         .remedy = "Give each emotion its share, as in happiness:0.6+anger:0.3."});
  }
  const auto heaviest = std::ranges::max_element(parts, {}, &EmotionModifier::intensity);
  EmotionMixture mixture{.heaviest = *heaviest};
  parts.erase(heaviest);
  mixture.others = std::move(parts);
  return mixture;
}

std::string format_emotions(const EmotionMixture& mixture) {
  const auto text_of = [](const EmotionModifier& part) {
    return part.intensity == 1.0 ? part.emotion
                                 : part.emotion + ":" + format_number(part.intensity);
  };
  std::string text = text_of(mixture.heaviest);
  for (const EmotionModifier& part : mixture.others) {
    text += "+" + text_of(part);
  }
  return text;
}

EmotionMixture mixture_of(const EmotionSpan& span) {
  return {.heaviest = {.emotion = span.emotion, .intensity = span.intensity},
          .others = span.others};
}

EmotionTrack parse_emotion_track(std::string_view text, std::string_view where) {
  if (!is_valid_utf8(text)) {
    throw InputError({.where = std::string(where),
                      .what = "is not UTF-8 text",
                      .expected = fmt::format("lines of {}", kLineForm)});
  }
  EmotionTrack track{.source = std::string(where), .spans = {}};
  long number = 0;
  for (std::string_view line : split_lines(text)) {
    ++number;
    line = trim(line.substr(0, line.find('#')));
    // An audio editor writes the frequency range of a label on a line of its own, after a
    // backslash.
    if (line.empty() || line.starts_with('\\')) {
      continue;
    }
    track.spans.push_back(parse_span(line, at_line(where, number)));
    track.spans.back().line = number;
  }
  std::ranges::stable_sort(track.spans, {}, &EmotionSpan::start_s);
  require_no_overlap(track);
  return track;
}

std::vector<EmotionModifier> assign_emotions(const EmotionTrack& track,
                                             std::span<const TimedPhoneme> phonemes,
                                             const EmotionModifier& fallback) {
  std::vector<EmotionModifier> emotions;
  emotions.reserve(phonemes.size());
  for (const TimedPhoneme& phoneme : phonemes) {
    Shares shares;
    double covered_to_s = phoneme.start_s;
    auto span = std::ranges::upper_bound(track.spans, phoneme.start_s, {}, &EmotionSpan::end_s);
    for (; span != track.spans.end() && span->start_s < phoneme.end_s; ++span) {
      const double start_s = std::max(span->start_s, phoneme.start_s);
      const double end_s = std::min(span->end_s, phoneme.end_s);
      shares.add(fallback.emotion, fallback.intensity, start_s - covered_to_s);
      shares.add(span->emotion, span->intensity, end_s - start_s);
      covered_to_s = end_s;
    }
    shares.add(fallback.emotion, fallback.intensity, phoneme.end_s - covered_to_s);
    emotions.push_back(shares.heaviest(fallback));
  }
  return emotions;
}

} // namespace phonomime
