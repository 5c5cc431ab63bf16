// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/scale/scaled_table.h"

#include "synth/search/cost_weights.h"
#include "synth/search/join_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>

namespace phonomime::bench {

namespace {

constexpr int kWaves = 3;

// Uniform in [-1, 1); std's distributions differ between libraries.
double symmetric(std::mt19937_64& random) {
  return 2.0 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1.0;
}

// A slow random motion of every coefficient over one sentence.
class Drift {
public:
  Drift(const Eigen::VectorXd& deviation, double spread, double frames, std::mt19937_64& random)
      : frames_(frames), waves_(kWaves + 1, deviation.size()) {
    for (Eigen::Index k = 0; k < waves_.cols(); ++k) {
      for (Eigen::Index w = 0; w <= kWaves; ++w) {
        waves_(w, k) = spread * deviation[k] * symmetric(random);
      }
    }
  }
  double at(double frame, Eigen::Index k) const {
    double sum = waves_(0, k);
    for (int w = 1; w <= kWaves; ++w) {
      sum += waves_(w, k) / w * std::cos(std::numbers::pi * w * frame / frames_);
    }
    return sum;
  }

private:
  double frames_;
  Eigen::MatrixXd waves_;
};

// First and one past the last node of each sentence that has nodes, in a random order, so that any
// number of them has every emotion in it.
std::vector<std::pair<NodeIndex, NodeIndex>> sentence_ranges(const MotionTable& table,
                                                             std::mt19937_64& random) {
  std::vector<std::pair<NodeIndex, NodeIndex>> ranges;
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    const std::int32_t sentence = table.nodes[static_cast<std::size_t>(node)].sentence;
    if (ranges.empty() ||
        table.nodes[static_cast<std::size_t>(ranges.back().first)].sentence != sentence) {
      ranges.emplace_back(node, node);
    }
    ranges.back().second = node + 1;
  }
  for (std::size_t left = ranges.size(); left > 1; --left) {
    std::swap(ranges[left - 1], ranges[random() % left]);
  }
  return ranges;
}

} // namespace

MotionTable scaled_table(const MotionTable& source, NodeIndex nodes, double spread) {
  MotionTable table = source;
  table.nodes.clear();
  table.sentences.clear();
  table.unavailable.clear();
  const Eigen::VectorXd deviation = source.pca.variance.cwiseMax(0.0).cwiseSqrt();
  const Eigen::Index dimensions = source.coefficients.cols();
  std::vector<float> frames;
  std::mt19937_64 random(20070);
  const auto ranges = sentence_ranges(source, random);
  for (std::size_t copy = 0; table.node_count() < nodes; ++copy) {
    const auto [begin, end] = ranges[copy % ranges.size()];
    const bool original = copy < ranges.size();
    const double pace = original ? 1.0 : 1.025 + 0.175 * symmetric(random);
    SentenceInfo sentence = source.sentences[static_cast<std::size_t>(
        source.nodes[static_cast<std::size_t>(begin)].sentence)];
    sentence.id += "r" + std::to_string(copy / ranges.size());
    double length = 0.0;
    for (NodeIndex i = begin; i < end; ++i) {
      length += source.nodes[static_cast<std::size_t>(i)].frame_count;
    }
    const Drift drift(deviation, original ? 0.0 : spread, length, random);
    const NodeIndex first_new = table.node_count();
    double passed = 0.0;
    for (NodeIndex i = begin; i < end && table.node_count() < nodes; ++i) {
      const MotionNode& from = source.nodes[static_cast<std::size_t>(i)];
      MotionNode node = from;
      const NodeIndex shift = first_new - begin;
      node.predecessor = from.predecessor == kNoNode ? kNoNode : from.predecessor + shift;
      node.successor = from.successor == kNoNode ? kNoNode : from.successor + shift;
      node.sentence = static_cast<std::int32_t>(table.sentences.size());
      node.first_frame = static_cast<std::int64_t>(frames.size()) / dimensions;
      node.frame_count = std::max(
          1, static_cast<std::int32_t>(std::lround(static_cast<double>(from.frame_count) * pace)));
      for (std::int32_t m = 0; m < node.frame_count; ++m) {
        const double u = node.frame_count == 1 ? 0.5 * (from.frame_count - 1)
                                               : static_cast<double>(m) * (from.frame_count - 1) /
                                                     (node.frame_count - 1);
        const auto below = static_cast<std::int32_t>(u);
        const std::int32_t above = std::min(below + 1, from.frame_count - 1);
        for (Eigen::Index k = 0; k < dimensions; ++k) {
          const double lower = source.coefficients(from.first_frame + below, k);
          const double upper = source.coefficients(from.first_frame + above, k);
          frames.push_back(
              static_cast<float>(lower + (u - below) * (upper - lower) + drift.at(passed + u, k)));
        }
      }
      passed += from.frame_count;
      table.nodes.push_back(node);
    }
    table.nodes.back().successor = kNoNode;
    table.sentences.push_back(sentence);
  }
  table.coefficients = Eigen::Map<const FrameMatrix>(
      frames.data(), static_cast<Eigen::Index>(frames.size()) / dimensions, dimensions);
  return table;
}

double median_cheapest_join(const MotionTable& table, const CostWeights& weights) {
  constexpr std::size_t kSample = 96;
  std::vector<NodeIndex> starts;
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    if (table.nodes[static_cast<std::size_t>(node)].predecessor != kNoNode) {
      starts.push_back(node);
    }
  }
  JoinCost cost(table, weights);
  std::vector<NodeIndex> all(table.nodes.size());
  std::iota(all.begin(), all.end(), 0);
  cost.ensure(all);
  std::vector<double> cheapest(std::min(kSample, starts.size()));
#pragma omp parallel for schedule(dynamic)
  for (std::size_t s = 0; s < cheapest.size(); ++s) {
    const NodeIndex to = starts[s * starts.size() / cheapest.size()];
    const NodeIndex before = table.nodes[static_cast<std::size_t>(to)].predecessor;
    double least = std::numeric_limits<double>::infinity();
    for (const NodeIndex from : all) {
      if (from == before) {
        continue;
      }
      const double gaps =
          weights.alpha3 * cost.position_gap(from, to) + cost.velocity_gap(from, to);
      if (gaps < least) {
        least = std::min(least, cost.ordinary_join(from, to));
      }
    }
    cheapest[s] = least;
  }
  const auto middle = cheapest.begin() + static_cast<std::ptrdiff_t>(cheapest.size() / 2);
  std::ranges::nth_element(cheapest, middle);
  return *middle;
}

ScaledTable scaled_like(const MotionTable& source, NodeIndex nodes) {
  constexpr double kTolerance = 0.2;
  const CostWeights weights = default_cost_weights(source);
  ScaledTable scaled;
  scaled.source_cheapest_join = median_cheapest_join(source, weights);
  double low = 0.0;
  double high = 2.0;
  for (int round = 0; round < 12; ++round) {
    scaled.spread = round == 0 ? 0.3 : 0.5 * (low + high);
    scaled.table = scaled_table(source, nodes, scaled.spread);
    scaled.cheapest_join = median_cheapest_join(scaled.table, weights);
    const double ratio = scaled.cheapest_join / scaled.source_cheapest_join;
    if (std::abs(ratio - 1.0) <= kTolerance) {
      return scaled;
    }
    (ratio < 1.0 ? low : high) = scaled.spread;
  }
  throw std::runtime_error("no spread keeps the median cheapest join of the source");
}

} // namespace phonomime::bench
