// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/curation/displaced_groups.h"

#include "db/types/suspect_mark.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace phonomime {

namespace {

constexpr int kMostDisplaced = 40;       // groups in one frame
constexpr std::size_t kMostCompared = 8; // of them, for swaps: pairs are many
constexpr double kSwapLeaves = 0.35;     // of the distance, once the two are exchanged
constexpr double kEdgeShare = 1.0 / 3;   // of the limit
constexpr double kHole_s = 0.03;         // within a run
constexpr double kQuick_s = 0.1;         // 25 recorded frames a second and one between
constexpr double kLookAround_s = 1.0;
constexpr double kLowShare = 0.2, kHighShare = 0.8; // of the peak

// What is displaced at one frame.
struct Displaced {
  int group = 0;
  Eigen::VectorXd by; // #channels of the group
  int partner = -1;
};

class Finder {
public:
  Finder(const NeighbourModel& model, const FrameMatrix& frames, const Layout& layout,
         double rate_hz)
      : model_(model), frames_(frames), width_(layout.channels_per_group()),
        groups_(layout.group_count()), rate_hz_(rate_hz), residuals_(model.residuals(frames)) {}

  std::vector<Displaced> at(Eigen::Index frame) const {
    std::vector<Displaced> found;
    if (!exceeds(frame)) {
      return found;
    }
    Eigen::VectorXd left = residuals_.row(frame).transpose();
    std::vector<char> taken(static_cast<std::size_t>(groups_), 0);
    while (static_cast<int>(found.size()) < kMostDisplaced) {
      int worst = -1;
      double most = 0.0;
      for (int group = 0; group < groups_; ++group) {
        const double length = left.segment(group * width_, width_).norm();
        if (taken[static_cast<std::size_t>(group)] == 0 && length > model_.limit(group) &&
            length > most) {
          most = length;
          worst = group;
        }
      }
      if (worst < 0) {
        break;
      }
      Displaced displaced{.group = worst, .by = left.segment(worst * width_, width_)};
      model_.take_off(worst, displaced.by, left.data());
      taken[static_cast<std::size_t>(worst)] = 1;
      found.push_back(std::move(displaced));
    }
    pair_swapped(frame, found);
    return found;
  }

  // Whether some group is beyond its limit.
  bool exceeds(Eigen::Index frame) const {
    const double* residual = &residuals_(frame, 0);
    for (int group = 0; group < groups_; ++group, residual += width_) {
      double length_sq = 0.0;
      for (int c = 0; c < width_; ++c) {
        length_sq += residual[c] * residual[c];
      }
      if (length_sq > model_.limit(group) * model_.limit(group)) {
        return true;
      }
    }
    return false;
  }

  // A displacement begins where it leaves what is usual, not where it comes to the limit: frames on
  // either side belong to the run while they are off by a third of it. Not into gaps.
  void widen(DisplacedRun& run, const std::vector<std::uint8_t>& frame_has_gap) const {
    const auto belongs = [&](Eigen::Index frame) {
      return frame >= 0 && frame < frames_.rows() &&
             frame_has_gap[static_cast<std::size_t>(frame)] == 0 &&
             length(frame, run.group) > kEdgeShare * model_.limit(run.group);
    };
    std::vector<double> before;
    while (belongs(run.first_frame - 1)) {
      --run.first_frame;
      before.push_back(length(run.first_frame, run.group));
    }
    run.size.insert(run.size.begin(), before.rbegin(), before.rend());
    Eigen::Index end = run.first_frame + static_cast<Eigen::Index>(run.size.size());
    for (; belongs(end); ++end) {
      run.size.push_back(length(end, run.group));
    }
    run.frame_count = end - run.first_frame;
  }

  // Of the residual before anything is taken off.
  double length(Eigen::Index frame, int group) const {
    return residuals_.row(frame).segment(group * width_, width_).norm();
  }

  DisplacedRun classify(DisplacedRun run) const {
    run.peak = *std::ranges::max_element(run.size);
    if (run.partner >= 0) {
      run.reason = suspect::kSwapped;
      return run;
    }
    const std::optional<double> rise = change(run, -1);
    const std::optional<double> fall = change(run, 1);
    const double slower = std::max(rise.value_or(0.0), fall.value_or(0.0));
    if (slower > kQuick_s) {
      run.reason = suspect::kDrift;
      run.change_s = slower;
    } else if (rise || fall) {
      run.reason = suspect::kJump;
      run.change_s = std::min(rise.value_or(slower), fall.value_or(slower));
    } else {
      run.reason = suspect::kNeighbours;
    }
    return run;
  }

private:
  Eigen::VectorXd place(Eigen::Index frame, int group) const {
    return frames_.row(frame).segment(group * width_, width_).cast<double>().transpose();
  }

  // Weights have no places to change: an exchanged pair of them is displaced like others.
  void pair_swapped(Eigen::Index frame, std::vector<Displaced>& found) const {
    if (width_ != 3) {
      return;
    }
    const std::size_t compared = std::min(kMostCompared, found.size());
    for (std::size_t a = 0; a < compared; ++a) {
      for (std::size_t b = a + 1; b < compared && found[a].partner < 0; ++b) {
        if (found[b].partner >= 0) {
          continue;
        }
        // The predicted place is the recorded one less the displacement.
        const Eigen::VectorXd apart = place(frame, found[a].group) - place(frame, found[b].group);
        const double leaves = std::max((found[a].by - apart).norm(), (found[b].by + apart).norm());
        if (leaves <= kSwapLeaves * apart.norm()) {
          found[a].partner = found[b].group;
          found[b].partner = found[a].group;
        }
      }
    }
  }

  double size_at(const DisplacedRun& run, Eigen::Index frame) const {
    const Eigen::Index inside = frame - run.first_frame;
    return inside >= 0 && inside < run.frame_count ? run.size[static_cast<std::size_t>(inside)]
                                                   : length(frame, run.group);
  }

  // How long the displacement takes to come (direction -1: looks back from where it has first come
  // to four fifths of its peak) or to go; nothing where the sentence ends before.
  std::optional<double> change(const DisplacedRun& run, int direction) const {
    const auto is_high = [&](double size) { return size >= kHighShare * run.peak; };
    Eigen::Index high = 0;
    if (direction < 0) {
      high = std::ranges::find_if(run.size, is_high) - run.size.begin();
    } else {
      high = run.size.rend() - std::find_if(run.size.rbegin(), run.size.rend(), is_high) - 1;
    }
    high += run.first_frame;
    const auto reach = static_cast<Eigen::Index>(kLookAround_s * rate_hz_);
    for (Eigen::Index k = high; k >= 0 && k < frames_.rows() && std::abs(k - high) <= reach;
         k += direction) {
      if (size_at(run, k) <= kLowShare * run.peak) {
        return static_cast<double>(std::abs(k - high)) / rate_hz_;
      }
    }
    const Eigen::Index edge = direction < 0 ? 0 : frames_.rows() - 1;
    return std::abs(edge - high) < reach ? std::nullopt : std::optional(kLookAround_s);
  }

  const NeighbourModel& model_;
  const FrameMatrix& frames_;
  int width_ = 3;
  int groups_ = 0;
  double rate_hz_ = 0.0;
  FrameMatrixD residuals_; // #frames by #channels
};

} // namespace

std::vector<DisplacedRun> displaced_runs(const NeighbourModel& model, const FrameMatrix& frames,
                                         const std::vector<std::uint8_t>& frame_has_gap,
                                         const Layout& layout, double rate_hz) {
  std::vector<DisplacedRun> runs;
  if (!model.known()) {
    return runs;
  }
  const Finder finder(model, frames, layout, rate_hz);
  const auto hole = static_cast<Eigen::Index>(kHole_s * rate_hz);
  std::map<std::pair<int, int>, DisplacedRun> open; // by group and partner
  const auto close_before = [&](Eigen::Index frame) {
    for (auto run = open.begin(); run != open.end();) {
      const Eigen::Index end = run->second.first_frame + run->second.frame_count;
      if (end + hole < frame) {
        finder.widen(run->second, frame_has_gap);
        runs.push_back(finder.classify(std::move(run->second)));
        run = open.erase(run);
      } else {
        ++run;
      }
    }
  };
  for (Eigen::Index frame = 0; frame < frames.rows(); ++frame) {
    close_before(frame);
    if (frame_has_gap[static_cast<std::size_t>(frame)] != 0) {
      continue;
    }
    for (const Displaced& displaced : finder.at(frame)) {
      DisplacedRun& run = open[{displaced.group, displaced.partner}];
      if (run.frame_count == 0) {
        run.group = displaced.group;
        run.partner = displaced.partner;
        run.first_frame = frame;
      }
      // Frames of a hole count with what they are off by.
      for (Eigen::Index k = run.first_frame + run.frame_count; k < frame; ++k) {
        run.size.push_back(finder.length(k, run.group));
      }
      run.size.push_back(displaced.by.norm());
      run.frame_count = frame + 1 - run.first_frame;
    }
  }
  close_before(frames.rows() + hole + 1);
  std::ranges::sort(runs, {}, [](const DisplacedRun& run) {
    return std::tuple(run.first_frame, run.group, run.partner);
  });
  return runs;
}

} // namespace phonomime
