// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/stream_transcript.h"

#include "db/import/alignment_rows.h"
#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::string_view kLineForm = "start end label [emotion]";

// The words of a line; none for a comment and an empty line.
std::vector<std::string_view> words_of(std::string_view line, const std::string& where) {
  const std::string_view text = trim(line);
  if (!is_valid_utf8(text)) {
    throw InputError({.where = where, .what = "the line is not UTF-8 text"});
  }
  if (text.empty() || text.starts_with('#')) {
    return {};
  }
  std::vector<std::string_view> words = split_words(text);
  if (words.size() < 3 || words.size() > 4) {
    throw InputError({.where = where,
                      .what = fmt::format("the line has {} words", words.size()),
                      .expected = std::string(kLineForm),
                      .got = quoted(text)});
  }
  return words;
}

double time_of(std::string_view word, std::string_view which, const std::string& where) {
  const std::optional<double> time = parse_number(word);
  if (!time) {
    throw InputError({.where = where,
                      .what = fmt::format("the {} is not a time", which),
                      .expected = "seconds, as in 1.25",
                      .got = quoted(word)});
  }
  return *time;
}

} // namespace

StreamTranscript::StreamTranscript(std::vector<PhonemeSet> sets, AskedEmotions emotions,
                                   std::string_view where)
    : sets_(std::move(sets)), emotions_(std::move(emotions)), last_{std::string(where), {}} {}

std::vector<StreamRow> StreamTranscript::read(std::string_view line) {
  const std::string where = at_line(last_.source, ++line_);
  const std::vector<std::string_view> words = words_of(line, where);
  if (words.empty()) {
    return {};
  }
  append_row(last_, {.label = std::string(words[2]),
                     .start_s = time_of(words[0], "start", where),
                     .end_s = time_of(words[1], "end", where),
                     .line = line_});
  if (last_.rows.back().end_s - end_s_ > kLongestTranscript_s) {
    throw InputError({.where = where,
                      .what = "the row, with the hole before it, is too long",
                      .expected = fmt::format("{} s at most", kLongestTranscript_s),
                      .got = format_number(last_.rows.back().end_s - end_s_) + " s",
                      .remedy = "Check the unit of its times."});
  }
  narrow_sets(last_.rows.back());
  // What came before goes with it, so that times are judged as in a file; what that gave is known.
  std::vector<StreamRow> rows;
  for (TimedPhoneme& phoneme : to_phonemes(last_, sets_.front())) {
    if (phoneme.end_s > end_s_) {
      phoneme.start_s = std::max(phoneme.start_s, end_s_);
      const std::vector<EmotionModifier> emotion =
          assign_emotions(emotions_.track, {&phoneme, 1}, emotions_.fallback.heaviest);
      rows.push_back({std::move(phoneme), emotion.front(), where});
    }
  }
  if (words.size() == 4 && !rows.empty()) {
    rows.back().emotion = parse_emotion_modifier(words[3], where);
  }
  if (!rows.empty()) {
    end_s_ = rows.back().phoneme.end_s;
  }
  // A silence of no duration does not end what came before it.
  const bool keep_first = rows.empty() && last_.rows.size() > 1;
  last_.rows.erase(last_.rows.begin() + (keep_first ? 1 : 0), last_.rows.end() - 1);
  return rows;
}

void StreamTranscript::narrow_sets(const AlignedLabel& row) {
  const auto knows = [&](const PhonemeSet& set) { return set.find(row.label) >= 0; };
  if (std::ranges::any_of(sets_, knows)) { // else to_phonemes says what is wrong
    std::erase_if(sets_, [&](const PhonemeSet& set) { return !knows(set); });
  }
}

} // namespace phonomime
