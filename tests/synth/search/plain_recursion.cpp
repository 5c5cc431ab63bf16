// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/synth/search/plain_recursion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace phonomime::test {

namespace {

// Sum of values, the k-th in lane k mod 4, lanes joined as (0 + 1) + (2 + 3).
double lane_sum(const std::vector<double>& values) {
  double lane[4] = {0.0, 0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < values.size(); ++k) {
    lane[k % 4] += values[k];
  }
  return (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

} // namespace

PlainRecursion::PlainRecursion(const MotionTable& table, const CostWeights& weights, Fit fit)
    : table_(table), weights_(weights), fit_(std::move(fit)) {
  for (const MotionNode& node : table.nodes) {
    const std::int64_t a = node.first_frame;
    const std::int64_t b = node.first_frame + node.frame_count - 1;
    first_pose_.push_back(channels(a));
    last_pose_.push_back(channels(b));
    first_velocity_.push_back(velocity(a, node.frame_count > 1 ? a + 1 : a));
    last_velocity_.push_back(velocity(node.frame_count > 1 ? b - 1 : b, b));
  }
}

double PlainRecursion::weight(Eigen::Index channel) const {
  const auto lips = [](const ChannelGroup& group) {
    return std::find(group.regions.begin(), group.regions.end(), Region::lips) !=
           group.regions.end();
  };
  const std::vector<ChannelGroup>& groups = table_.layout.groups;
  const auto own = static_cast<std::size_t>(channel / table_.layout.channels_per_group());
  return std::any_of(groups.begin(), groups.end(), lips) && !lips(groups[own]) ? weights_.off_lips
                                                                               : 1.0;
}

std::vector<float> PlainRecursion::channels(std::int64_t frame) const {
  std::vector<float> result;
  for (Eigen::Index c = 0; c < table_.pca.mean.size(); ++c) {
    double value = table_.pca.mean[c];
    for (Eigen::Index k = 0; k < table_.pca.basis.cols(); ++k) {
      value +=
          (table_.pca.basis(c, k) * weight(c)) * static_cast<double>(table_.coefficients(frame, k));
    }
    result.push_back(static_cast<float>(value));
  }
  return result;
}

std::vector<float> PlainRecursion::velocity(std::int64_t from_frame, std::int64_t to_frame) const {
  std::vector<float> result;
  for (Eigen::Index c = 0; c < table_.pca.mean.size(); ++c) {
    double from = table_.pca.mean[c];
    double to = table_.pca.mean[c];
    for (Eigen::Index k = 0; k < table_.pca.basis.cols(); ++k) {
      from += (table_.pca.basis(c, k) * weight(c)) *
              static_cast<double>(table_.coefficients(from_frame, k));
      to += (table_.pca.basis(c, k) * weight(c)) *
            static_cast<double>(table_.coefficients(to_frame, k));
    }
    result.push_back(static_cast<float>((to - from) * table_.rate_hz));
  }
  return result;
}

double PlainRecursion::gap(const std::vector<float>& a, const std::vector<float>& b) const {
  const int size = table_.layout.channels_per_group();
  std::vector<double> norms;
  for (int group = 0; group < table_.layout.group_count(); ++group) {
    double square = 0.0;
    for (int axis = 0; axis < size; ++axis) {
      const auto c = static_cast<std::size_t>(group * size + axis);
      const double difference = static_cast<double>(b[c]) - static_cast<double>(a[c]);
      square += difference * difference;
    }
    norms.push_back(std::sqrt(square));
  }
  return lane_sum(norms);
}

double PlainRecursion::smoothing(NodeIndex from, NodeIndex target) const {
  const auto w = table_.node_frames(from);
  const auto q = table_.node_frames(target);
  if (q.rows() < 3) {
    return 0.0;
  }
  FrameMatrixD blend(q.rows(), q.cols());
  for (Eigen::Index m = 0; m < q.rows(); ++m) {
    const double s = static_cast<double>(m) / static_cast<double>(q.rows() - 1);
    const double u = s * static_cast<double>(w.rows() - 1);
    const auto below = static_cast<Eigen::Index>(std::floor(u));
    const Eigen::Index above = std::min(below + 1, w.rows() - 1);
    for (Eigen::Index k = 0; k < q.cols(); ++k) {
      const double low = w(below, k);
      const double high = w(above, k);
      const double warped = low + (u - static_cast<double>(below)) * (high - low);
      blend(m, k) = (1.0 - s) * warped + s * static_cast<double>(q(m, k));
    }
  }
  double sum = 0.0;
  for (Eigen::Index m = 1; m + 1 < q.rows(); ++m) {
    std::vector<double> squares;
    for (Eigen::Index k = 0; k < q.cols(); ++k) {
      const double second = (blend(m - 1, k) + blend(m + 1, k)) - 2.0 * blend(m, k);
      squares.push_back(second * second);
    }
    sum += std::sqrt(lane_sum(squares));
  }
  return sum * table_.rate_hz;
}

double PlainRecursion::transition(NodeIndex from, NodeIndex to) const {
  const NodeIndex q = table_.nodes[static_cast<std::size_t>(to)].predecessor;
  if (q == from) {
    return 0.0;
  }
  if (q == kNoNode) {
    return weights_.alpha1 * weights_.pnt;
  }
  const auto i = static_cast<std::size_t>(from);
  const auto j = static_cast<std::size_t>(to);
  const double gaps = weights_.alpha3 * gap(last_pose_[i], first_pose_[j]) +
                      gap(last_velocity_[i], first_velocity_[j]);
  double cost = weights_.alpha2 == 0.0 ? 0.0 + gaps : weights_.alpha2 * smoothing(from, q) + gaps;
  if (table_.nodes[i].viseme != table_.nodes[static_cast<std::size_t>(q)].viseme) {
    cost += weights_.pnt;
  }
  return cost;
}

double PlainRecursion::penalty(const SearchStep& step, NodeIndex node) const {
  const MotionNode& info = table_.nodes[static_cast<std::size_t>(node)];
  double observation = 0.0;
  if (!step.is_silence && step.phoneme != info.phoneme) {
    observation = weights_.alpha5 * weights_.pnt;
    if (step.viseme == info.viseme) {
      observation = weights_.alpha4 * observation;
    }
  }
  const double paper =
      observation + (step.emotion == info.emotion ? 0.0 : weights_.alpha6 * weights_.pnt);
  return fit_ ? paper + fit_(step, node) : paper;
}

bool PlainRecursion::allowed(const SearchStep& step, NodeIndex node) {
  const auto in = [node](const std::vector<NodeIndex>& set) {
    return std::find(set.begin(), set.end(), node) != set.end();
  };
  return (step.allowed.empty() || in(step.allowed)) && !in(step.avoided);
}

PlainRecursion::Tables PlainRecursion::tables(std::span<const SearchStep> steps) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto n = table_.nodes.size();
  Tables result;
  result.phi.assign(steps.size(), std::vector<double>(n, kInfinity));
  result.chi.assign(steps.size(), std::vector<NodeIndex>(n, kNoNode));
  std::vector<double> tc(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      tc[i * n + j] = transition(static_cast<NodeIndex>(i), static_cast<NodeIndex>(j));
    }
  }
  for (std::size_t t = 0; t < steps.size(); ++t) {
    for (std::size_t j = 0; j < n; ++j) {
      const auto node = static_cast<NodeIndex>(j);
      if (!allowed(steps[t], node)) {
        continue;
      }
      const double own = penalty(steps[t], node);
      if (t == 0) {
        result.phi[t][j] = own;
        continue;
      }
      for (std::size_t i = 0; i < n; ++i) {
        const double value = (result.phi[t - 1][i] + tc[i * n + j]) + own;
        if (value < result.phi[t][j]) {
          result.phi[t][j] = value;
          result.chi[t][j] = static_cast<NodeIndex>(i);
        }
      }
    }
  }
  return result;
}

NodePath PlainRecursion::solve(std::span<const SearchStep> steps) const {
  const Tables found = tables(steps);
  NodePath path;
  path.nodes.resize(steps.size());
  const std::vector<double>& last = found.phi.back();
  std::size_t best = 0;
  for (std::size_t j = 1; j < last.size(); ++j) {
    if (last[j] < last[best]) {
      best = j;
    }
  }
  path.cost = last[best];
  auto node = static_cast<NodeIndex>(best);
  for (std::size_t t = steps.size(); t-- > 0;) {
    path.nodes[t] = node;
    node = found.chi[t][static_cast<std::size_t>(node)];
  }
  return path;
}

} // namespace phonomime::test
