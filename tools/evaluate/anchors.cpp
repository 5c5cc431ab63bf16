// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/anchors.h"

#include "db/types/errors.h"
#include "db/types/row_frames.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace phonomime {

namespace {

constexpr std::int32_t kSilentViseme = 0;

// A phoneme with its frames; what lies between two of them is silence.
struct SpokenRow {
  std::int32_t viseme = 0; // -1: unknown
  FrameRange frames;
};

double middle(const FrameRange& frames) {
  return static_cast<double>(frames.first) + 0.5 * static_cast<double>(frames.count - 1);
}

void add_inner_silence(std::vector<Anchor>& anchors, const FrameRange& silence, double reach) {
  const auto first = static_cast<double>(silence.first);
  const auto last = static_cast<double>(silence.end() - 1);
  if (last - first <= 2.0 * reach) {
    anchors.push_back({kSilentViseme, middle(silence)});
  } else {
    anchors.push_back({kSilentViseme, first + reach});
    anchors.push_back({kSilentViseme, last - reach});
  }
}

std::vector<Anchor> make_anchors(std::span<const SpokenRow> rows, bool starts_in_silence,
                                 bool ends_in_silence, double rate_hz) {
  const double reach = kRestReach_s * rate_hz;
  std::vector<Anchor> anchors;
  if (rows.empty()) {
    return anchors;
  }
  if (starts_in_silence) {
    anchors.push_back({kSilentViseme, static_cast<double>(rows.front().frames.first - 1) - reach});
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i > 0 && rows[i].frames.first > rows[i - 1].frames.end()) {
      const std::int64_t first = rows[i - 1].frames.end();
      add_inner_silence(anchors, {.first = first, .count = rows[i].frames.first - first}, reach);
    }
    if (rows[i].viseme >= 0) {
      anchors.push_back({rows[i].viseme, middle(rows[i].frames)});
    }
  }
  if (ends_in_silence) {
    anchors.push_back({kSilentViseme, static_cast<double>(rows.back().frames.end()) + reach});
  }
  return anchors;
}

bool is_whole(std::span<const MotionNode> nodes) {
  constexpr std::int32_t kPause = 0; // into MotionTable::phonemes
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const bool next = nodes[i].order == nodes[i - 1].order + 1;
    const bool after_pause =
        nodes[i - 1].next_phoneme == kPause && nodes[i].previous_phoneme == kPause;
    if (!next && !after_pause) {
      return false;
    }
  }
  return nodes.front().previous_phoneme == kPause && nodes.back().next_phoneme == kPause;
}

TrainingSentence make_training_sentence(std::span<const MotionNode> nodes, double rate_hz) {
  std::vector<SpokenRow> rows;
  for (const MotionNode& node : nodes) {
    rows.push_back({node.viseme, {.first = node.first_frame, .count = node.frame_count}});
  }
  const std::int64_t first = rows.front().frames.first;
  return {.anchors = make_anchors(rows, nodes.front().order > 0, true, rate_hz),
          .speech = {.first = first, .count = rows.back().frames.end() - first}};
}

std::vector<TrainingSentence> gather(const MotionTable& table, std::int32_t emotion,
                                     bool only_whole) {
  std::vector<TrainingSentence> sentences;
  for (std::size_t first = 0; first < table.nodes.size();) {
    std::size_t end = first;
    while (end < table.nodes.size() && table.nodes[end].sentence == table.nodes[first].sentence) {
      ++end;
    }
    const std::span nodes = std::span(table.nodes).subspan(first, end - first);
    const bool asked = emotion < 0 || nodes.front().emotion == emotion;
    if (asked && (!only_whole || is_whole(nodes))) {
      sentences.push_back(make_training_sentence(nodes, table.rate_hz));
    }
    first = end;
  }
  return sentences;
}

} // namespace

std::vector<TrainingSentence> training_sentences(const MotionTable& table, std::int32_t emotion) {
  constexpr std::int32_t kAnyEmotion = -1;
  for (const std::int32_t asked : {emotion, kAnyEmotion}) {
    for (const bool only_whole : {true, false}) {
      std::vector<TrainingSentence> sentences = gather(table, asked, only_whole);
      if (!sentences.empty()) {
        return sentences;
      }
    }
  }
  throw InputError({.what = "the database has no motion nodes"});
}

std::vector<Anchor> request_anchors(const MotionTable& table, const SentenceRequest& request) {
  const std::vector<FrameRange> frames = row_frames(request.rows, table.rate_hz);
  std::vector<SpokenRow> rows;
  for (std::size_t i = 0; i < request.rows.size(); ++i) {
    if (!request.rows[i].is_silence()) {
      rows.push_back({table.find_viseme(request.rows[i].phoneme.viseme).value_or(-1), frames[i]});
    }
  }
  return make_anchors(rows, request.rows.front().is_silence(), request.rows.back().is_silence(),
                      table.rate_hz);
}

VisemePoses mean_viseme_poses(const MotionTable& table,
                              const std::vector<TrainingSentence>& sentences) {
  const auto visemes = static_cast<Eigen::Index>(table.visemes.size());
  VisemePoses result{.poses = FrameMatrixD::Zero(visemes, table.coefficients.cols()),
                     .recorded = std::vector<bool>(table.visemes.size(), false)};
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(visemes);
  for (const TrainingSentence& sentence : sentences) {
    for (const Anchor& anchor : sentence.anchors) {
      if (anchor.viseme != kSilentViseme) {
        // Between two frames their mean: an even number of frames has two in its middle.
        const auto before = static_cast<Eigen::Index>(std::floor(anchor.frame));
        const auto after = static_cast<Eigen::Index>(std::ceil(anchor.frame));
        result.poses.row(anchor.viseme) +=
            0.5 * (table.coefficients.row(before) + table.coefficients.row(after)).cast<double>();
        counts(anchor.viseme) += 1.0;
      }
    }
  }
  const Eigen::RowVectorXd mean = result.poses.colwise().sum() / std::max(1.0, counts.sum());
  for (Eigen::Index viseme = 0; viseme < visemes; ++viseme) {
    const bool recorded = counts(viseme) > 0.0;
    result.recorded[static_cast<std::size_t>(viseme)] = recorded || viseme == kSilentViseme;
    if (recorded) {
      result.poses.row(viseme) /= counts(viseme);
    } else {
      result.poses.row(viseme) = mean;
    }
  }
  result.poses.row(kSilentViseme) = table.pca.project(table.reference_pose).transpose();
  return result;
}

} // namespace phonomime
