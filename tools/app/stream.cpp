// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/stream.h"

#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "synth/export/motion_csv.h"
#include "synth/pipeline/synthesis_stream.h"
#include "synth/search/streaming_search.h"
#include "tools/app/stream_transcript.h"
#include "tools/app/style_plan.h"
#include "tools/app/synth_inputs.h"
#include "tools/app/synth_outputs.h"
#include "tools/app/synth_stock.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr int kLongestLookAhead = 1000;

void refuse(bool given, const char* option, const char* why) {
  if (given) {
    throw UsageError({.where = option, .what = std::string("does not go with --stream: ") + why});
  }
}

void check_stream_options(const StreamOptions& options) {
  const SynthOptions& synth = options.synth;
  refuse(!synth.transcript.empty(), "TRANSCRIPT", "its lines come from standard input");
  refuse(!synth.outputs.empty(), "--output", "frames go to standard output");
  refuse(!synth.face.empty(), "--face", "frames are the markers' or weights' own, as CSV");
  refuse(!synth.audio.empty(), "--audio", "only a player has sound");
  refuse(!synth.tier.empty(), "--tier", "a stream of lines is no TextGrid");
  refuse(synth.retime, "--retime", "its rows are said when they say");
  refuse(synth.runners_up > 0, "--runners-up", "they need the whole transcript");
  refuse(synth.cost.value_or(CostModel::paper) != CostModel::paper, "--cost context",
         "it looks at what is said later");
  refuse(synth.blend.value_or(1) != 1, "--blend", "one path becomes final, not several");
  if (options.look_ahead < 0 || options.look_ahead > kLongestLookAhead) {
    throw UsageError({.where = "--look-ahead",
                      .what = "is out of range",
                      .expected = fmt::format("0 to {}", kLongestLookAhead),
                      .got = fmt::format("{}", options.look_ahead)});
  }
  check_synth_options(synth);
}

class SearchChooser : public NodeChooser {
public:
  SearchChooser(ViterbiSearch& search, const StreamOptions& options)
      : search_(search, options.look_ahead, {.threads = options.synth.threads}) {}

  std::vector<NodeIndex> push(const SearchStep& step) override { return search_.push(step); }
  std::vector<NodeIndex> finish() override { return search_.finish(); }
  double cost() const { return search_.cost(); }
  double lower_bound() { return search_.lower_bound(); }

private:
  StreamingSearch search_;
};

// The frames as text, numbered on from call to call.
class FrameWriter {
public:
  FrameWriter(const MotionTable& table, const SynthOptions& options, const StreamEnds& ends)
      : table_(table), options_(options), ends_(ends) {
    ends_.write(motion_csv_header(table.layout));
  }

  void write(FrameMatrixD frames) {
    if (frames.rows() == 0) {
      return;
    }
    CoefficientMotion motion{
        .rate_hz = options_.fps, .coefficients = std::move(frames), .head = {}};
    const auto count = motion.coefficients.rows();
    if (options_.head) {
      motion.head.assign(static_cast<std::size_t>(count), *options_.head);
    }
    ends_.write(motion_csv_rows(table_.layout, table_.pca, motion, options_.head.has_value(),
                                frame_count_));
    frame_count_ += count;
  }

  std::int64_t frame_count() const { return frame_count_; }

private:
  const MotionTable& table_;
  const SynthOptions& options_;
  const StreamEnds& ends_;
  std::int64_t frame_count_ = 0;
};

} // namespace

StreamReport run_stream(const StreamOptions& options, const StreamEnds& ends,
                        const Progress& progress) {
  check_stream_options(options);
  const SynthOptions& synth = options.synth;
  SynthStock stock(
      MotionDatabase::open(synth.database, OpenMode::read_only).load_motion_table(synth.speaker));
  const MotionTable& table = stock.table();
  const AskedEmotions emotions = read_asked_emotions(synth);
  check_recorded(emotions, table, "a stream");
  StreamTranscript transcript(phoneme_sets_to_try(synth, table), emotions, "standard input");
  ViterbiSearch search(table, read_weights(synth, stock.default_weights(CostModel::paper)));
  SearchChooser chooser(search, options);
  SynthesisStream stream(table, chooser,
                         {.constraints = read_constraints(synth),
                          .concat = concat_options(synth),
                          .fps = synth.fps,
                          .keep_steps = options.compare});
  const auto warn = [&] {
    for (const std::string& warning : stream.take_warnings()) {
      ends.warn(warning);
    }
  };
  FrameWriter writer(table, synth, ends);
  while (const std::optional<std::string> line = ends.next_line()) {
    for (const StreamRow& row : transcript.read(*line)) {
      check_recorded({.heaviest = row.emotion}, table, row.where, "a stream");
      writer.write(stream.push(row.phoneme, row.emotion));
    }
    warn();
  }
  writer.write(stream.finish());

  StreamReport report{.phonemes = stream.phoneme_count(),
                      .frames = writer.frame_count(),
                      .duration_s = stream.end_s()};
  if (stream.step_count() > 0) {
    report.cost = chooser.cost();
    if (options.bound_loss) {
      report.lower_bound = chooser.lower_bound();
    }
    if (options.compare) {
      report.optimum = search.solve(stream.steps(), {.threads = synth.threads}, progress).path.cost;
    }
  }
  return report;
}

} // namespace phonomime
