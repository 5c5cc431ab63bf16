// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/synthesize.h"

#include "synth/concat/resample.h"
#include "synth/pipeline/transcript_steps.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

namespace phonomime {

namespace {

bool is_captured(const MotionTable& table, const TimedPhoneme& row, const TimedPhoneme& before,
                 NodeIndex node, NodeIndex node_before) {
  return !row.is_silence() && !before.is_silence() && node != kNoNode &&
         table.nodes[static_cast<std::size_t>(node)].predecessor == node_before;
}

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
      row.captured = is_captured(table, row.phoneme, before.phoneme, row.node, before.node);
    }
  }
  return rows;
}

// Whether nothing in the path is joined otherwise than it was recorded, but at pauses.
bool is_recording(const std::vector<PathRow>& rows) {
  const PathRow* before = nullptr;
  for (const PathRow& row : rows) {
    if (before != nullptr && !row.captured && !row.phoneme.is_silence() &&
        !before->phoneme.is_silence()) {
      return false;
    }
    before = &row;
  }
  return true;
}

std::vector<ConcatStep> concat_steps(const MotionTable& table, const std::vector<PathRow>& rows,
                                     const std::vector<NodeIndex>& nodes) {
  std::vector<ConcatStep> steps;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const TimedPhoneme& phoneme = rows[i].phoneme;
    const bool captured =
        i > 0 && is_captured(table, phoneme, rows[i - 1].phoneme, nodes[i], nodes[i - 1]);
    steps.push_back({.is_silence = phoneme.is_silence(),
                     .start_s = phoneme.start_s,
                     .end_s = phoneme.end_s,
                     .node = nodes[i],
                     .captured = captured,
                     .show_node = phoneme.is_silence() && rows[i].constrained});
  }
  return steps;
}

std::vector<NodeIndex> nodes_of(const std::vector<PathRow>& rows) {
  std::vector<NodeIndex> nodes;
  for (const PathRow& row : rows) {
    nodes.push_back(row.node);
  }
  return nodes;
}

// The best path and those blended with it, as the result tells them.
void take_paths(const MotionTable& table, const SynthesisInput& input, const TranscriptSteps& steps,
                DisjointPaths& found, SynthesisResult& result) {
  result.cost = found.best.path.cost;
  result.counts = found.best.counts;
  result.rows = path_rows(table, input, steps, found.best);
  if (found.others.empty() || is_recording(result.rows)) {
    return;
  }
  for (const NodePath& path : found.others) {
    BlendedPath& blended = result.blended.emplace_back();
    blended.cost = path.cost;
    blended.nodes.assign(result.rows.size(), kNoNode);
    std::ranges::copy(path.nodes,
                      blended.nodes.begin() + static_cast<std::ptrdiff_t>(steps.first_row));
  }
}

// Of each row what its context lets expect, where paths are blended by a cost that asks for it.
std::vector<FrameMatrixD> expected_motions(SearchSpace& space, const TranscriptSteps& steps,
                                           const SynthesisResult& result) {
  if (result.blended.empty() || space.weights.target == 0.0) {
    return {};
  }
  std::vector<FrameMatrixD> expected(result.rows.size());
  for (std::size_t t = 0; t < steps.steps.size(); ++t) {
    if (!steps.steps[t].is_silence) {
      expected[steps.first_row + t] = space.fit.expected_frames(steps.steps[t], space.classes);
    }
  }
  return expected;
}

void share_weights(const SynthesisInput& input, bool expects, SynthesisResult& result) {
  const double share = expects ? input.concat.blend.expected_share : 0.0;
  result.expected_weight = share;
  result.weight = (1.0 - share) / static_cast<double>(result.blended.size() + 1);
  for (BlendedPath& path : result.blended) {
    path.weight = result.weight;
  }
}

} // namespace

SynthesisResult synthesize(const MotionTable& table, ViterbiSearch& search,
                           const SynthesisInput& input, const Progress& progress) {
  TranscriptSteps steps =
      make_transcript_steps(table, input.transcript, input.emotions, input.constraints);
  const auto begin = std::chrono::steady_clock::now();
  DisjointPaths found = search.solve_disjoint(steps.steps, input.blend, input.search, progress);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;

  SynthesisResult result;
  take_paths(table, input, steps, found, result);
  result.search_seconds = seconds.count();
  result.end_s = input.transcript.back().end_s;
  std::vector<std::vector<ConcatStep>> paths = {
      concat_steps(table, result.rows, nodes_of(result.rows))};
  for (const BlendedPath& path : result.blended) {
    paths.push_back(concat_steps(table, result.rows, path.nodes));
  }
  const std::vector<FrameMatrixD> expected = expected_motions(search.space(), steps, result);
  share_weights(input, !expected.empty(), result);
  result.motion = concatenate(table, paths, expected, input.concat);
  result.output = resample_motion(result.motion, input.fps, result.end_s);
  result.warnings = std::move(steps.warnings);
  return result;
}

} // namespace phonomime
