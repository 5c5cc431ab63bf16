// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/recording.h"

#include "db/import/normalise.h"
#include "db/types/errors.h"
#include "db/types/frame_times.h"
#include "db/types/text.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr double kSameTime_s = 1e-6;

std::string seconds(double time_s) {
  return fmt::format("{:.4g} s", time_s);
}

// The rows inside [start_s, end_s), moved to start at 0.
std::vector<TimedPhoneme> cut_rows(const std::vector<TimedPhoneme>& rows, double start_s,
                                   double end_s, double tolerance_s,
                                   const CorpusSentence& sentence) {
  std::vector<TimedPhoneme> cut;
  for (const TimedPhoneme& row : rows) {
    const double from = std::max(row.start_s, start_s);
    const double to = std::min(row.end_s, end_s);
    if (row.end_s <= start_s + kSameTime_s || row.start_s >= end_s - kSameTime_s) {
      continue;
    }
    if (!row.is_silence() && std::max(from - row.start_s, row.end_s - to) > tolerance_s) {
      throw InputError(
          {.where = sentence.where,
           .what = fmt::format("sentence {} is cut through a phoneme", quoted(sentence.id)),
           .expected = "start and end between phonemes",
           .got = fmt::format("{} from {} to {}, cut at {} and {}", row.phoneme.name,
                              seconds(row.start_s), seconds(row.end_s), seconds(start_s),
                              seconds(end_s)),
           .remedy = "Move the cut, or allow for more with --tolerance."});
    }
    cut.push_back({.phoneme = row.phoneme, .start_s = from - start_s, .end_s = to - start_s});
  }
  return cut;
}

void check_duration(double alignment_s, double motion_s, double tolerance_s, bool may_be_longer,
                    const CorpusSentence& sentence) {
  const double excess_s = alignment_s - motion_s;
  if (std::abs(excess_s) <= tolerance_s + kSameTime_s || (excess_s > 0.0 && may_be_longer)) {
    return;
  }
  throw InputError(
      {.where = sentence.where,
       .what = fmt::format("alignment {} is {} than its motion {}", quoted(sentence.alignment_name),
                           excess_s > 0.0 ? "longer" : "shorter", quoted(sentence.motion_name)),
       .expected = fmt::format("{} to within {}", seconds(motion_s), seconds(tolerance_s)),
       .got = seconds(alignment_s),
       .remedy = excess_s > 0.0
                     ? "Check that both are of the same recording, or allow for more with "
                       "--tolerance."
                     : "Check that both are of the same recording; end the alignment with a row "
                       "of silence, or allow for more with --tolerance."});
}

} // namespace

std::vector<Recording> recordings_of(const Corpus& corpus) {
  std::vector<Recording> recordings;
  std::map<std::filesystem::path, std::size_t> place;
  for (std::size_t i = 0; i < corpus.sentences.size(); ++i) {
    const CorpusSentence& sentence = corpus.sentences[i];
    const auto [found, is_new] = place.emplace(sentence.motion, recordings.size());
    if (is_new) {
      recordings.push_back(
          {.motion = sentence.motion, .motion_name = sentence.motion_name, .sentences = {}});
    }
    recordings[found->second].sentences.push_back(i);
  }
  return recordings;
}

RecordedSentence cut_sentence(const LayoutMotion& motion, const Alignment& alignment,
                              const CorpusSentence& sentence, const Corpus& corpus,
                              double tolerance_s) {
  const double file_s = static_cast<double>(motion.frames.rows()) / motion.rate_hz;
  const double start_s = sentence.start_s.value_or(0.0);
  const double end_s = sentence.end_s.value_or(file_s);
  if (end_s > file_s + tolerance_s + kSameTime_s || start_s >= file_s) {
    throw InputError({.where = sentence.where,
                      .what = fmt::format("sentence {} lies beyond its motion {}",
                                          quoted(sentence.id), quoted(sentence.motion_name)),
                      .expected = fmt::format("start and end up to {}", seconds(file_s)),
                      .got = fmt::format("{} and {}", seconds(start_s), seconds(end_s))});
  }
  RecordedSentence result;
  result.first_frame = first_frame_at(start_s, motion.rate_hz);
  const Eigen::Index after =
      std::min<Eigen::Index>(motion.frames.rows(), first_frame_at(end_s, motion.rate_hz));
  if (after <= result.first_frame) {
    throw InputError(
        {.where = sentence.where,
         .what = fmt::format("sentence {} is so short that it has no frame", quoted(sentence.id)),
         .got =
             fmt::format("{} at {} Hz", seconds(end_s - start_s), format_number(motion.rate_hz))});
  }
  result.frames = motion.frames.middleRows(result.first_frame, after - result.first_frame);
  result.clock = {.rate_hz = motion.rate_hz,
                  .start_s = static_cast<double>(result.first_frame) / motion.rate_hz - start_s};
  result.recorded_s = std::min(end_s, file_s) - start_s;
  check_groups(result.frames, corpus.layout, sentence.where, "sentence " + quoted(sentence.id),
               fmt::format("Check {}, or take the sentence out of the table.",
                           quoted(sentence.motion_name)));

  std::vector<TimedPhoneme> rows = to_phonemes(alignment, corpus.phoneme_set);
  const double aligned_s = rows.empty() ? 0.0 : rows.back().end_s;
  check_duration(aligned_s, end_s, tolerance_s, sentence.end_s.has_value(), sentence);
  const double cut_end_s = sentence.end_s ? end_s : std::max(aligned_s, end_s);
  if (sentence.start_s || sentence.end_s) {
    rows = cut_rows(rows, start_s, cut_end_s, tolerance_s, sentence);
  }
  result.duration_s = cut_end_s - start_s;
  const double rows_end_s = rows.empty() ? 0.0 : rows.back().end_s;
  if (result.duration_s - rows_end_s > kSameTime_s) {
    rows.push_back({.phoneme = corpus.phoneme_set.phonemes().front(),
                    .start_s = rows_end_s,
                    .end_s = result.duration_s});
  }
  result.rows = std::move(rows);
  return result;
}

} // namespace phonomime
