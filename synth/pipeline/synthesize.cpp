// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/synthesize.h"

#include "synth/concat/resample.h"
#include "synth/pipeline/transcript_steps.h"

#include <chrono>
#include <utility>

namespace phonomime {

namespace {

// The rows of the transcript with what the search found for them.
std::vector<PathRow> path_rows(const MotionTable& table, const SynthesisInput& input,
                               const TranscriptSteps& steps, SearchResult& found) {
  std::vector<PathRow> rows;
  for (std::size_t i = 0; i < input.transcript.size(); ++i) {
    rows.push_back({.phoneme = input.transcript[i], .emotion = input.emotions[i].emotion});
  }
  for (std::size_t t = 0; t < found.path.nodes.size(); ++t) {
    PathRow& row = rows[steps.first_row + t];
    row.node = found.path.nodes[t];
    row.constrained = steps.used[t];
    row.cost = found.path.steps[t];
    if (!found.runners_up.empty()) {
      row.runners_up = std::move(found.runners_up[t]);
    }
    if (t > 0) {
      const PathRow& before = rows[steps.first_row + t - 1];
      row.captured = !row.phoneme.is_silence() && !before.phoneme.is_silence() &&
                     table.nodes[static_cast<std::size_t>(row.node)].predecessor == before.node;
    }
  }
  return rows;
}

std::vector<ConcatStep> concat_steps(const std::vector<PathRow>& rows) {
  std::vector<ConcatStep> steps;
  for (const PathRow& row : rows) {
    const bool silence = row.phoneme.is_silence();
    steps.push_back({.is_silence = silence,
                     .start_s = row.phoneme.start_s,
                     .end_s = row.phoneme.end_s,
                     .node = row.node,
                     .captured = row.captured,
                     .show_node = silence && row.constrained});
  }
  return steps;
}

} // namespace

SynthesisResult synthesize(const MotionTable& table, ViterbiSearch& search,
                           const SynthesisInput& input, const Progress& progress) {
  TranscriptSteps steps =
      make_transcript_steps(table, input.transcript, input.emotions, input.constraints);
  const auto begin = std::chrono::steady_clock::now();
  SearchResult found = search.solve(steps.steps, input.search, progress);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;

  SynthesisResult result;
  result.cost = found.path.cost;
  result.counts = found.counts;
  result.search_seconds = seconds.count();
  result.end_s = input.transcript.back().end_s;
  result.rows = path_rows(table, input, steps, found);
  result.motion = concatenate(table, concat_steps(result.rows), input.concat);
  result.output = resample_motion(result.motion, input.fps, result.end_s);
  result.warnings = std::move(steps.warnings);
  return result;
}

} // namespace phonomime
