// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/curation/suspect_judge.h"

#include "db/curation/displaced_groups.h"
#include "db/curation/robust.h"
#include "db/curation/still_runs.h"
#include "db/curation/suspect_marks.h"
#include "db/types/errors.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace phonomime {

namespace {

constexpr std::size_t kMostSampled = 4000; // frames of a speaker; half of them at least
constexpr double kUsualStepShare = 0.99;
constexpr double kLeastMarkerStep = 0.05; // mm; what is usual is not less
constexpr double kLeastWeightStep = 0.005;
// Stored channels went through a resampling, so that what was still is so but for rounding; a run
// of recorded frames loses the time of one of them.
constexpr StillLimits kStoredStillness{.tolerance = 1e-3, .least_s = 0.08};

bool overlaps(std::pair<std::int32_t, std::int32_t> frames, Eigen::Index first,
              Eigen::Index count) {
  return first < frames.first + frames.second && frames.first < first + count;
}

} // namespace

SuspectJudge::SuspectJudge(Layout layout, double rate_hz)
    : layout_(std::move(layout)), rate_hz_(rate_hz), pose_groups_(pose_groups(layout_)) {}

std::string SuspectJudge::group_name(int group) const {
  return layout_.groups[static_cast<std::size_t>(group)].name;
}

void SuspectJudge::learn(const StoredSentence& sentence) {
  Sample& sample = samples_[sentence.speaker];
  const auto groups = static_cast<std::size_t>(layout_.group_count());
  const int width = layout_.channels_per_group();
  sample.steps.resize(groups);
  std::vector<char> bad(sentence.frame_has_gap.begin(), sentence.frame_has_gap.end());
  for (const StoredSentence::Node& node : sentence.nodes) {
    if (node.pruned) {
      std::fill_n(bad.begin() + node.first_frame, node.frame_count, char{1});
    }
  }
  for (Eigen::Index k = 1; k < sentence.channels.rows(); ++k) {
    if (bad[static_cast<std::size_t>(k)] != 0 || bad[static_cast<std::size_t>(k - 1)] != 0 ||
        sample.seen++ % sample.stride != 0) {
      continue;
    }
    sample.frames.emplace_back(sentence.channels.row(k));
    for (std::size_t group = 0; group < groups; ++group) {
      const auto column = static_cast<Eigen::Index>(group) * width;
      sample.steps[group].push_back((sentence.channels.row(k).segment(column, width) -
                                     sentence.channels.row(k - 1).segment(column, width))
                                        .norm());
    }
    if (sample.frames.size() == kMostSampled) {
      const auto thin_out = [](auto& values) {
        for (std::size_t i = 0; 2 * i < values.size(); ++i) {
          std::swap(values[i], values[2 * i]);
        }
        values.resize(values.size() / 2);
      };
      thin_out(sample.frames);
      std::ranges::for_each(sample.steps, thin_out);
      sample.stride *= 2;
    }
  }
}

void SuspectJudge::settle(int threads) {
  for (const auto& [speaker, sample] : samples_) {
    FrameMatrix frames(static_cast<Eigen::Index>(sample.frames.size()), layout_.channel_count());
    for (std::size_t k = 0; k < sample.frames.size(); ++k) {
      frames.row(static_cast<Eigen::Index>(k)) = sample.frames[k];
    }
    const double least = layout_.kind == LayoutKind::markers ? kLeastMarkerStep : kLeastWeightStep;
    std::vector<double> usual_step;
    for (const std::vector<float>& steps : sample.steps) {
      usual_step.push_back(
          steps.empty() ? least
                        : std::max(least, quantile({steps.begin(), steps.end()}, kUsualStepShare)));
    }
    learned_.emplace(speaker, Learned{.model = NeighbourModel(frames, layout_, threads),
                                      .usual_step = std::move(usual_step)});
  }
  samples_.clear();
}

void SuspectJudge::add_displaced(const StoredSentence& sentence, const Learned& learned,
                                 Look& look) const {
  const std::vector<DisplacedRun> runs =
      displaced_runs(learned.model, sentence.channels, sentence.frame_has_gap, layout_, rate_hz_);
  for (std::size_t node = 0; node < look.rows.size(); ++node) {
    const auto frames = look.frames[node];
    const auto largest_in_node = [&](const DisplacedRun& run) {
      const Eigen::Index from = std::max<Eigen::Index>(frames.first, run.first_frame);
      const Eigen::Index to =
          std::min<Eigen::Index>(frames.first + frames.second, run.first_frame + run.frame_count);
      return *std::max_element(run.size.begin() + (from - run.first_frame),
                               run.size.begin() + (to - run.first_frame));
    };
    for (const DisplacedRun& run : runs) {
      if (!overlaps(frames, run.first_frame, run.frame_count)) {
        continue;
      }
      const auto others =
          static_cast<std::size_t>(std::ranges::count_if(runs, [&](const DisplacedRun& other) {
            return &other != &run && other.reason == run.reason &&
                   overlaps(frames, other.first_frame, other.frame_count);
          }));
      SuspectMark mark{.reason = std::string(run.reason),
                       .score =
                           std::max(1.0, largest_in_node(run) / learned.model.limit(run.group)),
                       .first_frame = static_cast<std::int32_t>(run.first_frame),
                       .frame_count = static_cast<std::int32_t>(run.frame_count),
                       .groups = {group_name(run.group)},
                       .text = mark_text::displaced(run, learned.model, layout_, rate_hz_, others)};
      if (run.partner >= 0) {
        mark.groups.push_back(group_name(run.partner));
      }
      add_mark(look.own[node], std::move(mark));
    }
  }
}

void SuspectJudge::add_still(const StoredSentence& sentence, Look& look) const {
  const std::vector<StillRun> runs =
      still_runs(sentence.channels.cast<double>(), layout_, rate_hz_, kStoredStillness);
  for (std::size_t node = 0; node < look.rows.size(); ++node) {
    const auto in_node = [&](const StillRun& run) {
      return overlaps(look.frames[node], run.first_frame, run.frame_count);
    };
    const auto count = static_cast<std::size_t>(std::ranges::count_if(runs, in_node));
    for (const StillRun& run : runs) {
      if (in_node(run)) {
        add_mark(look.own[node], frozen_mark(run, SuspectOrigin::channels, layout_,
                                             {.rate_hz = rate_hz_, .others = count - 1}));
      }
    }
  }
}

void SuspectJudge::measure_steps(const StoredSentence& sentence, const Learned& learned,
                                 Look& look) const {
  const int width = layout_.channels_per_group();
  const FrameMatrix& frames = sentence.channels;
  for (std::size_t node = 0; node < look.rows.size(); ++node) {
    NodeMeasures& measures = look.measures[node];
    const auto [first, count] = look.frames[node];
    for (Eigen::Index k = std::max(1, first); k < first + count; ++k) {
      for (int group = 0; group < layout_.group_count(); ++group) {
        const double size = (frames.row(k).segment(group * width, width) -
                             frames.row(k - 1).segment(group * width, width))
                                .norm();
        const double step = size / learned.usual_step[static_cast<std::size_t>(group)];
        if (step > measures.step) {
          measures.step = step;
          measures.step_size = size;
          measures.step_group = group;
          measures.step_frame = k;
        }
      }
    }
  }
}

SuspectJudge::Look SuspectJudge::look(const StoredSentence& sentence) const {
  const auto learned = learned_.find(sentence.speaker);
  if (learned == learned_.end()) {
    throw InternalError({.where = sentence.name, .what = "a speaker who was not learned"});
  }
  const int width = layout_.channels_per_group();
  const auto pose_at = [&](Eigen::Index frame) {
    Eigen::VectorXf pose(static_cast<Eigen::Index>(pose_groups_.size()) * width);
    for (std::size_t i = 0; i < pose_groups_.size(); ++i) {
      pose.segment(static_cast<Eigen::Index>(i) * width, width) =
          sentence.channels.row(frame).segment(pose_groups_[i] * width, width).transpose();
    }
    return pose;
  };
  Look look;
  for (const StoredSentence::Node& node : sentence.nodes) {
    look.rows.push_back(node.row);
    look.frames.emplace_back(node.first_frame, node.frame_count);
    look.phonemes.push_back(node.phoneme);
    NodeMeasures measures;
    measures.cluster = sentence.speaker + "/" + node.phoneme;
    measures.duration_s = node.duration_s;
    measures.first = pose_at(node.first_frame);
    measures.last = pose_at(node.first_frame + node.frame_count - 1);
    measures.has_gap = node.has_gap;
    measures.left_out = node.has_gap || node.pruned;
    look.measures.push_back(std::move(measures));
  }
  look.own.resize(look.rows.size());
  measure_steps(sentence, learned->second, look);
  add_displaced(sentence, learned->second, look);
  add_still(sentence, look);
  return look;
}

std::vector<JudgedNode> SuspectJudge::judge(std::vector<Look>&& looks, int threads) const {
  std::vector<NodeMeasures> measures;
  for (std::size_t sentence = 0; sentence < looks.size(); ++sentence) {
    for (NodeMeasures& node : looks[sentence].measures) {
      node.sentence = sentence;
      measures.push_back(std::move(node));
    }
  }
  const auto durations = judge_durations(measures);
  const auto steps = judge_steps(measures);
  const auto poses = judge_poses(measures, layout_.kind, threads);
  std::vector<JudgedNode> judged;
  std::size_t at = 0;
  for (std::size_t sentence = 0; sentence < looks.size(); ++sentence) {
    Look& look = looks[sentence];
    for (std::size_t node = 0; node < look.rows.size(); ++node, ++at) {
      std::vector<SuspectMark>& marks = look.own[node];
      const auto [first, count] = look.frames[node];
      const std::string& phoneme = look.phonemes[node];
      const auto add = [&](std::string_view reason, double score, Eigen::Index from,
                           std::int32_t frames, std::string text) {
        SuspectMark mark{.reason = std::string(reason),
                         .score = score,
                         .first_frame = static_cast<std::int32_t>(from),
                         .frame_count = frames,
                         .text = std::move(text)};
        if (reason == suspect::kJump) {
          mark.groups.push_back(group_name(measures[at].step_group));
        }
        add_mark(marks, std::move(mark));
      };
      if (!measures[at].has_gap && steps[at] && steps[at]->score > 1.0) {
        add(suspect::kJump, steps[at]->score, measures[at].step_frame - 1, 2,
            mark_text::step(*steps[at], measures[at], phoneme, layout_, rate_hz_));
      }
      if (!measures[at].has_gap && poses[at] && poses[at]->verdict.score > 1.0) {
        add(suspect::kPose, poses[at]->verdict.score, poses[at]->last ? first + count - 1 : first,
            1, mark_text::pose(*poses[at], phoneme, layout_.kind));
      }
      if (durations[at] && durations[at]->score > 1.0) {
        add(suspect::kDuration, durations[at]->score, first, count,
            mark_text::duration(*durations[at], phoneme));
      }
      if (!marks.empty()) {
        std::ranges::sort(marks, {}, &SuspectMark::reason);
        judged.push_back({.sentence = sentence, .row = look.rows[node], .marks = std::move(marks)});
      }
    }
  }
  return judged;
}

} // namespace phonomime
