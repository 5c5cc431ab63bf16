// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/gaps.h"

#include <cmath>

namespace phonomime {

namespace {

bool is_present(const FrameMatrixD& frames, Eigen::Index frame, int group, int width) {
  return frames.row(frame).segment(static_cast<Eigen::Index>(group) * width, width).allFinite();
}

// Weights of the Lagrange polynomial through `support` at `at`, all in frames.
std::vector<double> lagrange_weights(const std::vector<Eigen::Index>& support, Eigen::Index at) {
  std::vector<double> weights(support.size(), 1.0);
  for (std::size_t i = 0; i < support.size(); ++i) {
    for (std::size_t j = 0; j < support.size(); ++j) {
      if (i != j) {
        weights[i] *=
            static_cast<double>(at - support[j]) / static_cast<double>(support[i] - support[j]);
      }
    }
  }
  return weights;
}

// The frames that a gap is filled from: the present ones beside it and, for a cubic, those beyond.
std::vector<Eigen::Index> support_of(const FrameMatrixD& frames, const Gap& gap, int width,
                                     bool wide) {
  const Eigen::Index before = gap.first_frame - 1;
  const Eigen::Index after = gap.first_frame + gap.frame_count;
  std::vector<Eigen::Index> support;
  if (wide && before >= 1 && is_present(frames, before - 1, gap.group, width)) {
    support.push_back(before - 1);
  }
  if (before >= 0) {
    support.push_back(before);
  }
  if (after < frames.rows()) {
    support.push_back(after);
  }
  if (wide && after + 1 < frames.rows() && is_present(frames, after + 1, gap.group, width)) {
    support.push_back(after + 1);
  }
  return support;
}

} // namespace

std::vector<int> groups_missing_throughout(const FrameMatrixD& frames, int channels_per_group) {
  std::vector<int> missing;
  const auto group_count = static_cast<int>(frames.cols() / channels_per_group);
  for (int group = 0; group < group_count; ++group) {
    Eigen::Index frame = 0;
    while (frame < frames.rows() && !is_present(frames, frame, group, channels_per_group)) {
      ++frame;
    }
    if (frame == frames.rows()) {
      missing.push_back(group);
    }
  }
  return missing;
}

GapFill fill_gaps(const FrameMatrixD& frames, int channels_per_group, double rate_hz,
                  double limit_s) {
  GapFill result{.frames = frames,
                 .frame_has_gap =
                     std::vector<std::uint8_t>(static_cast<std::size_t>(frames.rows())),
                 .gaps = {}};
  if (frames.allFinite()) {
    return result;
  }
  constexpr double kRounding_s = 1e-9;
  const auto group_count = static_cast<int>(frames.cols() / channels_per_group);
  for (int group = 0; group < group_count; ++group) {
    for (Eigen::Index first = 0; first < frames.rows(); ++first) {
      if (is_present(frames, first, group, channels_per_group)) {
        continue;
      }
      Eigen::Index after = first + 1;
      while (after < frames.rows() && !is_present(frames, after, group, channels_per_group)) {
        ++after;
      }
      Gap gap{.group = group, .first_frame = first, .frame_count = after - first};
      const bool at_an_end = first == 0 || after == frames.rows();
      const bool short_enough =
          static_cast<double>(gap.frame_count) / rate_hz <= limit_s + kRounding_s;
      gap.action = !short_enough ? GapAction::marked
                   : at_an_end   ? GapAction::held
                                 : GapAction::filled;
      const std::vector<Eigen::Index> support =
          support_of(frames, gap, channels_per_group, gap.action == GapAction::filled);
      const Eigen::Index column = static_cast<Eigen::Index>(group) * channels_per_group;
      for (Eigen::Index frame = first; frame < after; ++frame) {
        const std::vector<double> weights = lagrange_weights(support, frame);
        Eigen::VectorXd value = Eigen::VectorXd::Zero(channels_per_group);
        for (std::size_t i = 0; i < support.size(); ++i) {
          value +=
              weights[i] * frames.row(support[i]).segment(column, channels_per_group).transpose();
        }
        result.frames.row(frame).segment(column, channels_per_group) = value.transpose();
        if (gap.action == GapAction::marked) {
          result.frame_has_gap[static_cast<std::size_t>(frame)] = 1;
        }
      }
      result.gaps.push_back(gap);
      first = after;
    }
  }
  return result;
}

} // namespace phonomime
