// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/synthesize.h"

#include "synth/concat/resample.h"
#include "synth/pipeline/path_steps.h"
#include "synth/pipeline/style_path.h"
#include "synth/pipeline/transcript_steps.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace phonomime {

namespace {

// Of every row the node of a path through the steps.
std::vector<NodeIndex> nodes_of_rows(const SynthesisInput& input, const TranscriptSteps& steps,
                                     const NodePath& path) {
  std::vector<NodeIndex> nodes(input.transcript.size(), kNoNode);
  std::ranges::copy(path.nodes, nodes.begin() + static_cast<std::ptrdiff_t>(steps.first_row));
  return nodes;
}

// The rows of the transcript with what the search found for them.
std::vector<PathRow> path_rows(const MotionTable& table, const SynthesisInput& input,
                               const TranscriptSteps& steps, SearchResult& found) {
  const std::vector<NodeIndex> nodes = nodes_of_rows(input, steps, found.path);
  std::vector<PathRow> rows;
  for (std::size_t i = 0; i < input.transcript.size(); ++i) {
    rows.push_back({.phoneme = input.transcript[i],
                    .emotion = input.emotions[i].emotion,
                    .node = nodes[i],
                    .captured = is_captured(table, input.transcript, nodes, i)});
  }
  for (std::size_t t = 0; t < found.path.nodes.size(); ++t) {
    PathRow& row = rows[steps.first_row + t];
    row.constrained = steps.used[t];
    row.cost = found.path.steps[t];
    if (!found.runners_up.empty()) {
      row.runners_up = std::move(found.runners_up[t]);
    }
  }
  return rows;
}

// Whether nothing in a path is joined otherwise than it was recorded, but at pauses.
bool is_recording(const MotionTable& table, std::span<const TimedPhoneme> transcript,
                  std::span<const NodeIndex> nodes) {
  for (std::size_t i = 1; i < transcript.size(); ++i) {
    if (!transcript[i].is_silence() && !transcript[i - 1].is_silence() &&
        !is_captured(table, transcript, nodes, i)) {
      return false;
    }
  }
  return true;
}

// The best path and those blended with it, as the result tells them.
void take_paths(const MotionTable& table, const SynthesisInput& input, const TranscriptSteps& steps,
                DisjointPaths& found, SynthesisResult& result) {
  result.cost = found.best.path.cost;
  result.counts = found.best.counts;
  result.rows = path_rows(table, input, steps, found.best);
  for (const NodePath& path : found.others) {
    result.blended.push_back({.cost = path.cost, .nodes = nodes_of_rows(input, steps, path)});
  }
}

// What every path of a result is made into motion by, the best one's first.
std::vector<std::vector<ConcatStep>> steps_of_paths(const MotionTable& table,
                                                    const SynthesisInput& input,
                                                    const SynthesisResult& result) {
  std::vector<std::vector<ConcatStep>> paths;
  const auto add = [&](std::span<const NodeIndex> nodes) {
    std::vector<ConcatStep>& steps = paths.emplace_back(path_steps(table, input.transcript, nodes));
    for (std::size_t i = 0; i < steps.size(); ++i) {
      steps[i].show_node = steps[i].is_silence && result.rows[i].constrained;
    }
  };
  std::vector<NodeIndex> best;
  std::ranges::transform(result.rows, std::back_inserter(best), &PathRow::node);
  add(best);
  for (const BlendedPath& path : result.blended) {
    add(path.nodes);
  }
  return paths;
}

// Of each row what its context lets expect, where paths are blended by a cost that asks for it;
// nothing at all where something that is shown expects nothing.
std::vector<FrameMatrixD> expected_motions(SearchSpace& space, const TranscriptSteps& steps,
                                           const SynthesisResult& result) {
  if (result.blended.empty() || space.weights.target == 0.0) {
    return {};
  }
  std::vector<FrameMatrixD> expected(result.rows.size());
  for (std::size_t t = 0; t < steps.steps.size(); ++t) {
    if (steps.steps[t].is_silence && !steps.used[t]) {
      continue; // is filled
    }
    FrameMatrixD& frames = expected[steps.first_row + t];
    frames = space.fit.expected_frames(steps.steps[t], space.classes);
    if (frames.rows() == 0) {
      return {};
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
  const auto is_spoken_anew = [&](const NodePath& best) {
    return !is_recording(table, input.transcript, nodes_of_rows(input, steps, best));
  };
  DisjointPaths found =
      search.solve_disjoint(steps.steps, input.blend, input.search, progress, is_spoken_anew);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;

  SynthesisResult result;
  take_paths(table, input, steps, found, result);
  result.search_seconds = seconds.count();
  result.end_s = input.transcript.back().end_s;
  const std::vector<FrameMatrixD> expected = expected_motions(search.space(), steps, result);
  share_weights(input, !expected.empty(), result);
  result.motion = concatenate(table, steps_of_paths(table, input, result), expected, input.concat);
  result.warnings = std::move(steps.warnings);
  if (input.style.model != nullptr) {
    style_path(table, input, result);
  }
  result.output = resample_motion(result.motion, input.fps, result.end_s);
  return result;
}

} // namespace phonomime
