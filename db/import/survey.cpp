// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/survey.h"

#include "db/import/head_scale.h"
#include "db/import/readers.h"
#include "db/import/reference_pose.h"
#include "db/import/sentence_table.h"
#include "db/types/errors.h"
#include "db/types/frame_times.h"
#include "db/types/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::ptrdiff_t kFilesAtOnce = 32;

// Frames that may become a speaker's reference pose.
struct Candidates {
  std::vector<Eigen::RowVectorXf> frames; // #channels each, complete, head motion on
  std::vector<std::size_t> sentences;
  std::vector<double> times_s;
  void add(const RecordedSentence& recorded, Eigen::Index frame, std::size_t sentence) {
    frames.push_back(recorded.frames.row(frame).cast<float>());
    sentences.push_back(sentence);
    times_s.push_back(recorded.clock.start_s + static_cast<double>(frame) / recorded.clock.rate_hz);
  }
  void add(Candidates&& other) {
    std::move(other.frames.begin(), other.frames.end(), std::back_inserter(frames));
    sentences.insert(sentences.end(), other.sentences.begin(), other.sentences.end());
    times_s.insert(times_s.end(), other.times_s.begin(), other.times_s.end());
  }
};

// What is found in one motion file.
struct FileFindings {
  double rate_hz = 0.0;
  std::int64_t frames = 0;
  std::int64_t frames_outside = 0;
  std::int64_t frames_shared = 0;
  std::vector<std::string> extra_groups;
  std::map<std::string, HeadSizes> sizes;       // by speaker
  std::map<std::string, Candidates> candidates; // by speaker
  std::vector<std::size_t> good;                // sentences
  std::vector<Rejection> rejections;
};

// What the look at a file needs to know beforehand.
struct SurveyContext {
  const Corpus& corpus;
  const RecordingOptions& options;
  std::optional<HeadAnchor> anchor;       // markers only
  std::set<std::string> neutral_speakers; // that have neutral sentences
  std::set<std::string> settled_speakers; // that need no candidates
};

void add_candidates(const RecordedSentence& recorded, std::size_t index,
                    const SurveyContext& context, std::map<std::string, Candidates>& candidates) {
  const CorpusSentence& sentence = context.corpus.sentences[index];
  const std::string& speaker = sentence.speaker;
  if (!context.anchor || context.settled_speakers.contains(speaker)) {
    return;
  }
  const auto named = context.corpus.reference_frames.find(speaker);
  if (named != context.corpus.reference_frames.end()) {
    if (named->second.sentence != index) {
      return;
    }
    const double at = (named->second.time_s - recorded.clock.start_s) * recorded.clock.rate_hz;
    const auto frame = static_cast<Eigen::Index>(std::llround(at));
    if (frame < 0 || frame >= recorded.frames.rows() || !recorded.frames.row(frame).allFinite()) {
      throw InputError(
          {.where = sentence.where,
           .what = fmt::format("the reference frame of speaker \"{}\", {} s, is not in "
                               "the motion or lacks a marker",
                               speaker, named->second.time_s),
           .remedy = "Name another reference_frame in corpus.json."});
    }
    candidates[speaker].add(recorded, frame, index);
    return;
  }
  if (context.neutral_speakers.contains(speaker) && sentence.emotion != kNeutral) {
    return;
  }
  for (const TimedPhoneme& row : recorded.rows) {
    if (!row.is_silence()) {
      continue;
    }
    const auto frame_at = [&](double time_s) {
      return std::clamp<Eigen::Index>(
          first_frame_at(time_s - recorded.clock.start_s, recorded.clock.rate_hz), 0,
          recorded.frames.rows());
    };
    for (Eigen::Index frame = frame_at(row.start_s); frame < frame_at(row.end_s); ++frame) {
      if (recorded.frames.row(frame).allFinite()) {
        candidates[speaker].add(recorded, frame, index);
      }
    }
  }
}

void look_at_sentence(std::size_t index, const LayoutMotion& motion, const SurveyContext& context,
                      FileFindings& findings, std::vector<std::uint8_t>& frame_use) {
  const CorpusSentence& sentence = context.corpus.sentences[index];
  const RecordedSentence recorded =
      cut_sentence(motion, read_alignment(sentence.alignment, context.corpus.alignment_options),
                   sentence, context.corpus, context.options.tolerance_s);
  add_candidates(recorded, index, context, findings.candidates);
  if (context.anchor && context.anchor->gives_rotation) {
    findings.sizes[sentence.speaker].add(recorded.frames, *context.anchor);
  }
  for (Eigen::Index k = 0; k < recorded.frames.rows(); ++k) {
    std::uint8_t& used = frame_use[static_cast<std::size_t>(recorded.first_frame + k)];
    findings.frames_shared += used;
    used = 1;
  }
  findings.good.push_back(index);
}

FileFindings look_at_file(const Recording& recording, const SurveyContext& context) {
  FileFindings findings;
  try {
    const LayoutMotion motion =
        to_layout(read_motion(recording.motion), context.corpus.layout, recording.motion.string());
    findings.rate_hz = motion.rate_hz;
    findings.frames = motion.frames.rows();
    findings.extra_groups = motion.extra_groups;
    std::vector<std::uint8_t> frame_use(static_cast<std::size_t>(motion.frames.rows()), 0);
    for (const std::size_t index : recording.sentences) {
      try {
        look_at_sentence(index, motion, context, findings, frame_use);
      } catch (const InputError& error) {
        if (!context.options.skip_faulty) {
          throw;
        }
        findings.rejections.push_back({index, error.what()});
      }
    }
    findings.frames_outside = std::count(frame_use.begin(), frame_use.end(), std::uint8_t{0});
  } catch (const InputError& error) {
    if (!context.options.skip_faulty) {
      throw;
    }
    for (const std::size_t index : recording.sentences) {
      findings.rejections.push_back({index, error.what()});
    }
  }
  return findings;
}

// What is gathered from all files, and the survey does not keep.
struct Gathered {
  std::map<std::string, Candidates> candidates; // by speaker
  std::map<std::string, HeadSizes> sizes;       // by speaker
};

void gather(FileFindings&& findings, const Recording& recording, Survey& survey,
            Gathered& gathered) {
  survey.files += 1;
  survey.file_frames += findings.frames;
  survey.frames_outside += findings.frames_outside;
  survey.frames_shared += findings.frames_shared;
  for (const std::string& group : findings.extra_groups) {
    ++survey.extra_groups[group];
  }
  for (auto& [speaker, found] : findings.candidates) {
    gathered.candidates[speaker].add(std::move(found));
  }
  for (const auto& [speaker, sizes] : findings.sizes) {
    gathered.sizes[speaker].add(sizes);
  }
  survey.rejections.insert(survey.rejections.end(), findings.rejections.begin(),
                           findings.rejections.end());
  if (!findings.good.empty()) {
    survey.fastest_rate_hz = std::max(survey.fastest_rate_hz, findings.rate_hz);
    survey.recordings.push_back({.motion = recording.motion,
                                 .motion_name = recording.motion_name,
                                 .sentences = std::move(findings.good)});
  }
}

ReferencePose choose_reference(const std::string& speaker, Candidates& candidates,
                               const SurveyContext& context, Scale scale) {
  if (candidates.frames.empty()) {
    throw InputError({.where = context.corpus.folder.string(),
                      .what = fmt::format("speaker \"{}\" has no frame of silence in which all "
                                          "markers are there: there is no reference pose",
                                          speaker),
                      .remedy = "Name a reference_frame in corpus.json."});
  }
  FrameMatrix frames(static_cast<Eigen::Index>(candidates.frames.size()),
                     candidates.frames.front().size());
  for (Eigen::Index k = 0; k < frames.rows(); ++k) {
    frames.row(k) = candidates.frames[static_cast<std::size_t>(k)];
    candidates.frames[static_cast<std::size_t>(k)].resize(0);
  }
  const Eigen::Index nearest = frame_nearest_to_median(frames, *context.anchor, scale);
  const bool is_named = context.corpus.reference_frames.contains(speaker);
  return {.pose =
              centred_on_anchor(frames.row(nearest).transpose().cast<double>(), *context.anchor),
          .origin = is_named                                     ? "named frame"
                    : context.neutral_speakers.contains(speaker) ? "median of neutral silence"
                                                                 : "median of silence",
          .sentence = candidates.sentences[static_cast<std::size_t>(nearest)],
          .time_s = candidates.times_s[static_cast<std::size_t>(nearest)]};
}

void choose_references(Survey& survey, std::map<std::string, Candidates>& candidates,
                       const SurveyContext& context,
                       const std::map<std::string, Eigen::VectorXd>& known_references) {
  std::set<std::string> speakers;
  for (const Recording& recording : survey.recordings) {
    for (const std::size_t index : recording.sentences) {
      speakers.insert(context.corpus.sentences[index].speaker);
    }
  }
  for (const std::string& speaker : speakers) {
    const auto known = known_references.find(speaker);
    if (known != known_references.end()) {
      survey.references[speaker] = {
          .pose = known->second, .origin = "database", .sentence = {}, .time_s = 0.0};
    } else if (!context.anchor) {
      survey.references[speaker] = {
          .pose = Eigen::VectorXd::Zero(context.corpus.layout.channel_count()),
          .origin = "zero",
          .sentence = {},
          .time_s = 0.0};
    } else {
      survey.references[speaker] =
          choose_reference(speaker, candidates[speaker], context, survey.scale);
      candidates.erase(speaker);
    }
  }
}

} // namespace

Survey survey_corpus(const Corpus& corpus, const RecordingOptions& options, const KnownHeads& known,
                     const Progress& progress) {
  SurveyContext context{.corpus = corpus,
                        .options = options,
                        .anchor = std::nullopt,
                        .neutral_speakers = {},
                        .settled_speakers = {}};
  if (corpus.layout.kind == LayoutKind::markers) {
    context.anchor = head_anchor(corpus.layout);
  }
  for (const CorpusSentence& sentence : corpus.sentences) {
    if (sentence.emotion == kNeutral) {
      context.neutral_speakers.insert(sentence.speaker);
    }
  }
  for (const auto& [speaker, pose] : known.references) {
    context.settled_speakers.insert(speaker);
  }
  const std::vector<Recording> recordings = recordings_of(corpus);
  const auto count = static_cast<std::ptrdiff_t>(recordings.size());
  Survey survey;
  Gathered gathered;
  for (std::ptrdiff_t first = 0; first < count; first += kFilesAtOnce) {
    progress.update("reading", first, count);
    std::vector<FileFindings> found(
        static_cast<std::size_t>(std::min(kFilesAtOnce, count - first)));
    parallel_for(static_cast<std::ptrdiff_t>(found.size()), options.threads, [&](std::ptrdiff_t i) {
      found[static_cast<std::size_t>(i)] =
          look_at_file(recordings[static_cast<std::size_t>(first + i)], context);
    });
    for (std::size_t i = 0; i < found.size(); ++i) {
      gather(std::move(found[i]), recordings[static_cast<std::size_t>(first) + i], survey,
             gathered);
    }
  }
  progress.update("reading", count, count);
  std::ranges::sort(survey.rejections, {}, &Rejection::sentence);
  if (survey.recordings.empty()) {
    throw InputError({.where = corpus.folder.string(),
                      .what = "every sentence of the corpus is faulty",
                      .got = survey.rejections.front().reason});
  }
  if (context.anchor) {
    const FoundScale found = choose_scale(
        {.asked = options.scale, .layout = corpus.layout.scale, .database = known.scale},
        gathered.sizes, *context.anchor, corpus.folder.string());
    survey.scale = found.scale;
    survey.scale_origin = found.origin;
    survey.size_variation = found.size_variation;
  }
  choose_references(survey, gathered.candidates, context, known.references);
  return survey;
}

} // namespace phonomime
