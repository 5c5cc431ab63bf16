// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/shown_face.h"

#include <algorithm>
#include <array>
#include <set>

namespace phonomime {

namespace {

constexpr std::array<std::string_view, 4> kLipLandmarks = {
    "lip_lower_inner", "lip_upper_inner", "mouth_corner_right", "mouth_corner_left"};

Eigen::VectorXd mean_pose(const std::vector<ShownSentence>& shown) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(shown.front().recorded.cols());
  double frames = 0.0;
  for (const ShownSentence& sentence : shown) {
    sum += sentence.recorded.cast<double>().colwise().sum().transpose();
    frames += static_cast<double>(sentence.recorded.rows());
  }
  return sum / std::max(frames, 1.0);
}

// The largest squared distance of two markers over some of the frames: lips that meet at rest are
// no neighbours once they have opened.
double farthest_sq(const std::vector<ShownSentence>& shown, int a, int b) {
  constexpr Eigen::Index kEvery = 5;
  double largest = 0.0;
  for (const ShownSentence& sentence : shown) {
    for (Eigen::Index k = 0; k < sentence.recorded.rows(); k += kEvery) {
      const auto frame = sentence.recorded.row(k);
      const float sq = (frame.segment<3>(3 * a) - frame.segment<3>(3 * b)).squaredNorm();
      largest = std::max(largest, static_cast<double>(sq));
    }
  }
  return largest;
}

std::vector<std::pair<int, int>> neighbours(const Layout& layout,
                                            const std::vector<ShownSentence>& shown) {
  constexpr std::size_t kNearest = 2;
  std::set<std::pair<int, int>> edges;
  for (int a = 0; a < layout.group_count(); ++a) {
    const Region region = drawn_region(layout.groups[static_cast<std::size_t>(a)]);
    std::vector<std::pair<double, int>> others;
    for (int b = 0; b < layout.group_count(); ++b) {
      if (b != a && drawn_region(layout.groups[static_cast<std::size_t>(b)]) == region) {
        others.emplace_back(farthest_sq(shown, a, b), b);
      }
    }
    std::ranges::sort(others);
    others.resize(std::min(others.size(), kNearest));
    for (const auto& [distance_sq, b] : others) {
      edges.emplace(std::min(a, b), std::max(a, b));
    }
  }
  return {edges.begin(), edges.end()};
}

// Sum over frames of the squared distance from the pose.
double movement(const std::vector<ShownSentence>& shown, const Eigen::VectorXd& pose, int group,
                Eigen::Index width) {
  double sum = 0.0;
  for (const ShownSentence& sentence : shown) {
    const auto channels = sentence.recorded.middleCols(group * width, width).cast<double>();
    sum += (channels.rowwise() - pose.segment(group * width, width).transpose()).squaredNorm();
  }
  return sum;
}

std::vector<int> traced_groups(const Layout& layout, const std::vector<ShownSentence>& shown,
                               const Eigen::VectorXd& pose) {
  std::vector<int> traced;
  const auto add = [&](int group) {
    if (std::ranges::find(traced, group) == traced.end()) {
      traced.push_back(group);
    }
  };
  for (const std::string_view landmark : kLipLandmarks) {
    if (const auto group = layout.find_landmark(landmark)) {
      add(*group);
    }
  }
  for (std::size_t r = 0; r < kRegionNames.size(); ++r) {
    if (static_cast<Region>(r) == Region::rigid) {
      continue;
    }
    int most = -1;
    double largest = -1.0;
    for (const int group : layout.groups_in(static_cast<Region>(r))) {
      const double moved = movement(shown, pose, group, layout.channels_per_group());
      if (moved > largest) {
        most = group;
        largest = moved;
      }
    }
    if (most >= 0) {
      add(most);
    }
  }
  if (traced.empty()) {
    add(0);
  }
  return traced;
}

} // namespace

Region drawn_region(const ChannelGroup& group) {
  return group.regions.empty() ? Region::rigid : group.regions.front();
}

ShownFace shown_face(const Layout& layout, const std::vector<ShownSentence>& shown) {
  ShownFace face;
  face.pose = mean_pose(shown);
  if (layout.kind == LayoutKind::markers) {
    face.edges = neighbours(layout, shown);
  }
  face.traced = traced_groups(layout, shown, face.pose);
  return face;
}

} // namespace phonomime
