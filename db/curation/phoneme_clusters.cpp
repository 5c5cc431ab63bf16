// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/curation/phoneme_clusters.h"

#include "db/curation/robust.h"
#include "db/types/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace phonomime {

namespace {

// docs/curation.md says what the limits were chosen by.
constexpr std::size_t kLeastNodes = 20;
constexpr double kDurationSigmas = 7.0;
constexpr double kLeastDurationSigma = 0.2; // octaves
constexpr double kStepSigmas = 8.0;
constexpr double kLeastStepSigma = 0.3; // octaves
constexpr double kLeastStep = 2.0;      // times usual
constexpr double kPoseSigmas = 8.0;
constexpr double kLeastPoseSigma = 0.2;  // octaves
constexpr double kLeastMarkerPose = 2.0; // mm
constexpr double kLeastWeightPose = 0.1;
constexpr int kPoseGroups = 16;
constexpr std::size_t kReferences = 256; // boundary poses that each is first compared with

using Clusters = std::map<std::string, std::vector<std::size_t>>; // into the nodes

Clusters clusters_of(const std::vector<NodeMeasures>& nodes) {
  Clusters clusters;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    clusters[nodes[i].cluster].push_back(i);
  }
  return clusters;
}

// Median and reach, in octaves, of the members that count; nothing where they are too few.
struct Reach {
  RobustSpread octaves;
  std::size_t count = 0;
};

template <typename Value>
std::optional<Reach> reach_of(const std::vector<std::size_t>& members,
                              const std::vector<NodeMeasures>& nodes, const Value& value) {
  std::vector<double> octaves;
  for (const std::size_t i : members) {
    if (!nodes[i].left_out && value(i) > 0.0) {
      octaves.push_back(std::log2(value(i)));
    }
  }
  if (octaves.size() < kLeastNodes) {
    return std::nullopt;
  }
  const std::size_t count = octaves.size();
  return Reach{.octaves = robust_spread(std::move(octaves)), .count = count};
}

double squared_distance(const Eigen::VectorXf& a, const Eigen::VectorXf& b) {
  return static_cast<double>((a - b).squaredNorm());
}

// Distance (squared sum) of each boundary pose of a cluster from the nearest of another sentence.
class NearestPoses {
public:
  NearestPoses(const std::vector<NodeMeasures>& nodes, const std::vector<std::size_t>& members)
      : nodes_(nodes) {
    for (const std::size_t i : members) {
      if (!nodes[i].left_out) {
        others_.push_back(i);
      }
    }
    step_ = std::max<std::size_t>(1, 2 * others_.size() / kReferences);
  }

  double distance_sq(std::size_t node, const Eigen::VectorXf& pose, std::size_t step) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < others_.size(); i += step) {
      const NodeMeasures& other = nodes_[others_[i]];
      if (other.sentence != nodes_[node].sentence) {
        least = std::min(
            {least, squared_distance(pose, other.first), squared_distance(pose, other.last)});
      }
    }
    return least;
  }
  std::size_t step() const { return step_; }

private:
  const std::vector<NodeMeasures>& nodes_;
  std::vector<std::size_t> others_;
  std::size_t step_ = 1;
};

} // namespace

std::vector<int> pose_groups(const Layout& layout) {
  const int step = std::max(1, (layout.group_count() + kPoseGroups - 1) / kPoseGroups);
  std::vector<int> groups;
  for (int group = 0; group < layout.group_count(); group += step) {
    groups.push_back(group);
  }
  return groups;
}

std::vector<std::optional<ClusterVerdict>> judge_durations(const std::vector<NodeMeasures>& nodes) {
  std::vector<std::optional<ClusterVerdict>> verdicts(nodes.size());
  for (const auto& [cluster, members] : clusters_of(nodes)) {
    const auto value = [&](std::size_t i) { return nodes[i].duration_s; };
    const std::optional<Reach> reach = reach_of(members, nodes, value);
    if (!reach) {
      continue;
    }
    const double width = kDurationSigmas * std::max(kLeastDurationSigma, reach->octaves.sigma);
    for (const std::size_t i : members) {
      const double off = std::abs(std::log2(std::max(value(i), 1e-6)) - reach->octaves.median);
      verdicts[i] = {.score = off / width,
                     .value = value(i),
                     .usual = std::exp2(reach->octaves.median),
                     .least = std::exp2(reach->octaves.median - width),
                     .most = std::exp2(reach->octaves.median + width),
                     .count = reach->count};
    }
  }
  return verdicts;
}

std::vector<std::optional<ClusterVerdict>> judge_steps(const std::vector<NodeMeasures>& nodes) {
  std::vector<std::optional<ClusterVerdict>> verdicts(nodes.size());
  for (const auto& [cluster, members] : clusters_of(nodes)) {
    const auto value = [&](std::size_t i) { return nodes[i].step; };
    const std::optional<Reach> reach = reach_of(members, nodes, value);
    if (!reach) {
      continue;
    }
    const double width = kStepSigmas * std::max(kLeastStepSigma, reach->octaves.sigma);
    const double most = std::max(kLeastStep, std::exp2(reach->octaves.median + width));
    for (const std::size_t i : members) {
      const double unit = nodes[i].step > 0.0 ? nodes[i].step_size / nodes[i].step : 0.0;
      verdicts[i] = {.score = nodes[i].step / most,
                     .value = nodes[i].step_size,
                     .usual = unit * std::exp2(reach->octaves.median),
                     .most = unit * most,
                     .count = reach->count};
    }
  }
  return verdicts;
}

std::vector<std::optional<PoseVerdict>> judge_poses(const std::vector<NodeMeasures>& nodes,
                                                    LayoutKind kind, int threads) {
  std::vector<std::optional<PoseVerdict>> verdicts(nodes.size());
  const Clusters clusters = clusters_of(nodes);
  std::vector<const std::vector<std::size_t>*> all;
  for (const auto& [cluster, members] : clusters) {
    all.push_back(&members);
  }
  parallel_for(static_cast<std::ptrdiff_t>(all.size()), threads, [&](std::ptrdiff_t at) {
    const std::vector<std::size_t>& members = *all[static_cast<std::size_t>(at)];
    if (members.size() < kLeastNodes) {
      return;
    }
    const NearestPoses nearest(nodes, members);
    const auto channels = static_cast<double>(nodes[members.front()].first.size()) /
                          (kind == LayoutKind::markers ? 3.0 : 1.0);
    std::vector<double> distances(members.size());
    std::vector<char> is_last(members.size());
    const auto measure = [&](std::size_t m, std::size_t step) {
      const NodeMeasures& node = nodes[members[m]];
      const double first = nearest.distance_sq(members[m], node.first, step);
      const double last = nearest.distance_sq(members[m], node.last, step);
      is_last[m] = last > first ? 1 : 0;
      distances[m] = std::sqrt(std::max(first, last) / channels);
    };
    for (std::size_t m = 0; m < members.size(); ++m) {
      measure(m, nearest.step());
    }
    std::map<std::size_t, double> by_node;
    for (std::size_t m = 0; m < members.size(); ++m) {
      by_node[members[m]] = std::isfinite(distances[m]) ? distances[m] : 0.0;
    }
    const std::optional<Reach> reach =
        reach_of(members, nodes, [&](std::size_t i) { return by_node.at(i); });
    if (!reach) {
      return;
    }
    const double width = kPoseSigmas * std::max(kLeastPoseSigma, reach->octaves.sigma);
    const double most = std::max(kind == LayoutKind::markers ? kLeastMarkerPose : kLeastWeightPose,
                                 std::exp2(reach->octaves.median + width));
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (distances[m] > most) {
        measure(m, 1); // there may be a nearer one that is no reference
      }
      if (std::isfinite(distances[m])) {
        verdicts[members[m]] = {.verdict = {.score = distances[m] / most,
                                            .value = distances[m],
                                            .usual = std::exp2(reach->octaves.median),
                                            .most = most,
                                            .count = reach->count},
                                .last = is_last[m] != 0};
      }
    }
  });
  return verdicts;
}

} // namespace phonomime
