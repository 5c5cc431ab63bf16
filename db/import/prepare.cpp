// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/prepare.h"

#include "db/import/nodes.h"
#include "db/import/normalise.h"
#include "db/import/readers.h"
#include "db/import/recorded_faults.h"
#include "db/types/errors.h"
#include "db/types/frame_times.h"
#include "db/types/parallel_for.h"
#include "db/types/text.h"

#include <algorithm>

#include <fmt/format.h>

namespace phonomime {

namespace {

// Frames of `rate_hz` that have no recorded frame on both sides.
std::int64_t count_held(const SourceClock& clock, Eigen::Index recorded, double rate_hz,
                        Eigen::Index count) {
  const double last_s = clock.start_s + static_cast<double>(recorded - 1) / clock.rate_hz;
  const auto before = std::min<std::int64_t>(count, first_frame_at(clock.start_s, rate_hz));
  const auto to_last = std::min<std::int64_t>(count, frame_count_to(last_s, rate_hz));
  return std::max<std::int64_t>(0, before) + (count - std::max<std::int64_t>(0, to_last));
}

// A node with a gap stays out of the PCA whole: its other frames are marked too.
void spread_gaps_over_nodes(ImportedSentence& sentence) {
  for (ImportedNode& node : sentence.nodes) {
    const auto first = sentence.frame_has_gap.begin() + node.first_frame;
    const auto last = first + node.frame_count;
    node.has_gap = std::find(first, last, std::uint8_t{1}) != last;
    if (node.has_gap) {
      std::fill(first, last, std::uint8_t{1});
    }
  }
}

NormalMotion normal_motion(const RecordedSentence& recorded, const CorpusSentence& sentence,
                           Eigen::Index count, const PrepareContext& context) {
  const Layout& layout = context.corpus.layout;
  Eigen::VectorXd reference;
  if (layout.kind == LayoutKind::markers) {
    reference = context.survey.references.at(sentence.speaker).pose;
  }
  return normalise(recorded.frames, recorded.clock, layout, reference, context.survey.scale,
                   {.where = sentence.where,
                    .whose = "sentence " + quoted(sentence.id),
                    .gap_limit_s = context.options.gap_limit_s,
                    .rate_hz = context.rate_hz,
                    .frames = count});
}

PreparedSentence prepare(std::size_t index, RecordedSentence& recorded,
                         const PrepareContext& context) {
  const CorpusSentence& sentence = context.corpus.sentences[index];
  const Eigen::Index count = first_frame_at(recorded.duration_s, context.rate_hz);
  NormalMotion motion = normal_motion(recorded, sentence, count, context);

  PreparedSentence result;
  ImportedSentence& made = result.sentence;
  made.speaker = sentence.speaker;
  made.emotion = sentence.emotion;
  made.id = sentence.id;
  made.text = sentence.text;
  made.audio = sentence.audio.string();
  made.nodes = cut_into_nodes(recorded.rows, context.rate_hz, sentence.where);
  made.channels = motion.channels.cast<float>();
  made.frame_has_gap = std::move(motion.frame_has_gap);
  made.head = std::move(motion.head);
  spread_gaps_over_nodes(made);

  SentenceAccount& account = result.account;
  mark_recorded_faults(made.nodes, recorded, motion.gaps, context.corpus.layout, context.rate_hz);
  account.sentence = index;
  account.clock = recorded.clock;
  account.recorded_frames = recorded.frames.rows();
  account.frames = count;
  account.nodes = static_cast<std::int64_t>(made.nodes.size());
  for (const ImportedNode& node : made.nodes) {
    account.in_nodes += node.frame_count;
    account.nodes_with_gap += node.has_gap;
  }
  account.in_silence = account.frames - account.in_nodes;
  account.held_frames = count_held(recorded.clock, recorded.frames.rows(), context.rate_hz, count);
  account.gap_frames =
      std::count(made.frame_has_gap.begin(), made.frame_has_gap.end(), std::uint8_t{1});
  for (const Gap& gap : motion.gaps) {
    account.missing += gap.frame_count;
  }
  account.interpolated_poses = motion.interpolated_poses;
  account.gaps = std::move(motion.gaps);
  made.rows = std::move(recorded.rows);
  return result;
}

} // namespace

PreparedRecording prepare_recording(const Recording& recording, const PrepareContext& context) {
  const Corpus& corpus = context.corpus;
  const LayoutMotion motion =
      to_layout(read_motion(recording.motion), corpus.layout, recording.motion.string());
  PreparedRecording result;
  for (const std::size_t index : recording.sentences) {
    const CorpusSentence& sentence = corpus.sentences[index];
    RecordedSentence recorded =
        cut_sentence(motion, read_alignment(sentence.alignment, corpus.alignment_options), sentence,
                     corpus, context.options.tolerance_s);
    try {
      result.sentences.push_back(prepare(index, recorded, context));
    } catch (const InputError& error) {
      if (!context.options.skip_faulty) {
        throw;
      }
      result.rejections.push_back({.sentence = index, .reason = error.what()});
      result.rejected_frames += recorded.frames.rows();
    }
  }
  return result;
}

void prepare_recordings(const PrepareContext& context, const Progress& progress,
                        std::string_view stage,
                        const std::function<void(std::vector<PreparedRecording>& some)>& take) {
  constexpr std::ptrdiff_t kFilesAtOnce = 16;
  const std::vector<Recording>& recordings = context.survey.recordings;
  const auto count = static_cast<std::ptrdiff_t>(recordings.size());
  for (std::ptrdiff_t first = 0; first < count; first += kFilesAtOnce) {
    progress.update(stage, first, count);
    std::vector<PreparedRecording> prepared(
        static_cast<std::size_t>(std::min(kFilesAtOnce, count - first)));
    parallel_for(static_cast<std::ptrdiff_t>(prepared.size()), context.options.threads,
                 [&](std::ptrdiff_t i) {
                   prepared[static_cast<std::size_t>(i)] =
                       prepare_recording(recordings[static_cast<std::size_t>(first + i)], context);
                 });
    take(prepared);
  }
  progress.update(stage, count, count);
}

} // namespace phonomime
