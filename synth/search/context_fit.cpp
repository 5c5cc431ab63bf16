// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/context_fit.h"

#include "db/types/time_warp.h"
#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace phonomime {

namespace {

constexpr double kOffLipsShare = 0.25;        // of the target distance
constexpr double kLookFade = 0.78;            // from one look to the next: to 1/e in 0.12 s
constexpr float kUnknownDissimilarity = 1.0f; // of a phoneme that was never recorded

// The distance of the target term, over the variance of all motion: metric with
// |metric c|^2 = sum over groups of share |E_k c|^2 / variance.
FrameMatrixD target_metric(const MotionTable& table) {
  const int axes = table.layout.channels_per_group();
  const auto lips = static_cast<double>(table.layout.groups_in(Region::lips).size());
  const double others = table.layout.group_count() - lips;
  Eigen::VectorXd shares(table.pca.channel_count());
  for (int group = 0; group < table.layout.group_count(); ++group) {
    const bool lip = table.layout.groups[static_cast<std::size_t>(group)].in(Region::lips);
    const double share = lip ? 1.0 / lips : (lips == 0.0 ? 1.0 : kOffLipsShare) / others;
    shares.segment(axes * group, axes).setConstant(share);
  }
  const Eigen::MatrixXd square =
      table.pca.basis.transpose() * shares.asDiagonal() * table.pca.basis;
  const double variance = square.diagonal().dot(table.pca.variance.cwiseMax(0.0));
  const Eigen::LDLT<Eigen::MatrixXd> factors(square / std::max(variance, 1e-12));
  const Eigen::VectorXd roots = factors.vectorD().cwiseMax(1e-12).cwiseSqrt();
  const Eigen::MatrixXd upper = factors.matrixU();
  const Eigen::MatrixXd order =
      factors.transpositionsP() * Eigen::MatrixXd::Identity(square.rows(), square.cols());
  return roots.asDiagonal() * upper * order;
}

// Sum of squared differences, in lanes; `count` a multiple of the number of lanes.
PHONOMIME_DISPATCHED
float squared_distance(const float* a, const float* b, std::size_t count) {
  FloatLanes sum = {};
  for (std::size_t i = 0; i < count; i += kFloatLanes) {
    FloatLanes left, right;
    load(left, a + i);
    load(right, b + i);
    const FloatLanes difference = left - right;
    sum += difference * difference;
  }
  return sum_of_lanes(sum);
}

std::array<double, Surroundings::kLooks> look_weights() {
  std::array<double, Surroundings::kLooks> weights;
  double weight = 1.0;
  double sum = 0.0;
  for (double& look : weights) {
    look = weight;
    sum += weight;
    weight *= kLookFade;
  }
  for (double& look : weights) {
    look /= sum;
  }
  return weights;
}

} // namespace

ContextFit::ContextFit(const MotionTable& table, const CostWeights& weights)
    : table_(table), weights_(weights), counts_(weights.goes_beyond_the_paper()),
      padded_((static_cast<std::size_t>(table.pca.dimension_count()) + kFloatLanes - 1) /
              kFloatLanes * kFloatLanes),
      records_(table.nodes.size(), kSamples * padded_) {
  if (counts_) {
    metric_ = target_metric(table);
    inverse_metric_ = metric_.inverse();
    surroundings_ = recorded_surroundings(table);
    learn_dissimilarities();
  }
}

void ContextFit::learn_dissimilarities() {
  const auto phonemes = static_cast<Eigen::Index>(table_.phonemes.size());
  Eigen::MatrixXd poses = Eigen::MatrixXd::Zero(phonemes, table_.pca.dimension_count());
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(phonemes);
  std::vector<std::uint8_t> spoken(static_cast<std::size_t>(table_.coefficients.rows()), 0);
  for (const MotionNode& node : table_.nodes) {
    poses.row(node.phoneme) +=
        table_.coefficients.row(node.first_frame + node.frame_count / 2).cast<double>();
    counts[node.phoneme] += 1.0;
    std::fill_n(spoken.begin() + node.first_frame, node.frame_count, std::uint8_t{1});
  }
  for (std::size_t frame = 0; frame < spoken.size(); ++frame) {
    if (spoken[frame] == 0) { // /pau/
      poses.row(0) += table_.coefficients.row(static_cast<Eigen::Index>(frame)).cast<double>();
      counts[0] += 1.0;
    }
  }
  poses = counts.cwiseMax(1.0).cwiseInverse().asDiagonal() * poses * metric_.transpose();
  const auto size = static_cast<std::size_t>(phonemes);
  dissimilarities_.assign(size * size, kUnknownDissimilarity);
  double sum = 0.0;
  double pairs = 0.0;
  const auto distance = [&](std::size_t a, std::size_t b) {
    return (poses.row(static_cast<Eigen::Index>(a)) - poses.row(static_cast<Eigen::Index>(b)))
        .norm();
  };
  const auto known = [&](std::size_t a) { return counts[static_cast<Eigen::Index>(a)] > 0.0; };
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (known(a) && known(b)) {
        sum += distance(a, b);
        pairs += 1.0;
      }
    }
  }
  const double mean = sum > 0.0 ? sum / pairs : 1.0;
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = 0; b < size; ++b) {
      if (a == b) {
        dissimilarities_[a * size + b] = 0.0f;
      } else if (known(a) && known(b)) {
        dissimilarities_[a * size + b] = static_cast<float>(distance(a, b) / mean);
      }
    }
  }
}

float ContextFit::dissimilarity(std::int32_t a, std::int32_t b) const {
  if (a < 0 || b < 0) {
    return kUnknownDissimilarity;
  }
  return dissimilarities_[static_cast<std::size_t>(a) * table_.phonemes.size() +
                          static_cast<std::size_t>(b)];
}

void ContextFit::fill_record(NodeIndex node, float* record) const {
  FrameMatrixD samples(static_cast<Eigen::Index>(kSamples), metric_.cols());
  time_warp(table_.node_frames(node), samples);
  std::fill_n(record, record_floats(), 0.0f);
  Eigen::VectorXd made(metric_.rows());
  for (std::size_t s = 0; s < kSamples; ++s, record += padded_) {
    // Column after column, so that the compiler's vectors sum in the order of the scalar code.
    made.setZero();
    for (Eigen::Index j = 0; j < metric_.cols(); ++j) {
      made += samples(static_cast<Eigen::Index>(s), j) * metric_.col(j);
    }
    std::ranges::transform(made, record, [](double value) { return static_cast<float>(value); });
  }
}

void ContextFit::ensure(std::span<const NodeIndex> nodes) {
  records_.ensure(nodes, [this](NodeIndex node, float* record) { fill_record(node, record); });
}

const ExpectedMotion* ContextFit::expected_motion(const SearchStep& step,
                                                  const NodeClasses& classes) {
  // Of the phoneme; of its viseme where the phoneme was never recorded.
  const std::pair asked(step.phoneme, step.viseme);
  const auto known = expected_.find(asked);
  if (known != expected_.end()) {
    return known->second ? &*known->second : nullptr;
  }
  std::vector<NodeIndex> nodes;
  const auto gather = [&](std::int32_t MotionNode::*member, std::int32_t value) {
    for (std::size_t c = 0; c < classes.size(); ++c) {
      const std::span<const NodeIndex> members = classes.nodes(c);
      if (table_.nodes[static_cast<std::size_t>(members.front())].*member == value) {
        nodes.insert(nodes.end(), members.begin(), members.end());
      }
    }
  };
  gather(&MotionNode::phoneme, step.phoneme);
  if (nodes.empty()) {
    gather(&MotionNode::viseme, step.viseme);
  }
  std::optional<ExpectedMotion>& made = expected_[asked];
  if (!nodes.empty()) {
    ensure(nodes);
    std::vector<const float*> records;
    std::vector<PhonemeContext> contexts;
    for (const NodeIndex node : nodes) {
      records.push_back(records_[node]);
      contexts.push_back({table_.nodes[static_cast<std::size_t>(node)].emotion,
                          surroundings_[static_cast<std::size_t>(node)]});
    }
    made.emplace(records, record_floats(), contexts);
  }
  return made ? &*made : nullptr;
}

FrameMatrixD ContextFit::expected_frames(const SearchStep& step, const NodeClasses& classes) {
  const ExpectedMotion* expected = expected_motion(step, classes);
  FrameMatrixD frames = FrameMatrixD::Zero(expected == nullptr ? 0 : kSamples, metric_.cols());
  if (expected != nullptr) {
    const std::vector<double> record = expected->in({step.emotion, step.surroundings});
    for (Eigen::Index s = 0; s < frames.rows(); ++s) {
      const Eigen::Map<const Eigen::VectorXd> sample(
          record.data() + static_cast<std::size_t>(s) * padded_, metric_.rows());
      frames.row(s) = (inverse_metric_ * sample).transpose();
    }
  }
  return frames;
}

ContextFit::Wish ContextFit::wish(const SearchStep& step, const NodeClasses& classes) {
  Wish wish;
  wish.asks = !step.is_silence;
  if (!wish.asks) {
    return wish;
  }
  wish.surroundings = step.surroundings;
  if (weights_.target > 0.0) {
    if (const ExpectedMotion* expected = expected_motion(step, classes)) {
      const std::vector<double> record = expected->in({step.emotion, step.surroundings});
      wish.target.assign(record.begin(), record.end());
    }
  }
  if (weights_.context > 0.0) {
    const std::array<double, Surroundings::kLooks> looks = look_weights();
    const auto phonemes = static_cast<std::int32_t>(table_.phonemes.size());
    for (const auto* asked : {&step.surroundings.before, &step.surroundings.after}) {
      for (std::size_t j = 0; j < looks.size(); ++j) {
        for (std::int32_t phoneme = 0; phoneme < phonemes; ++phoneme) {
          wish.context.push_back(static_cast<float>(looks[j]) *
                                 dissimilarity((*asked)[j], phoneme));
        }
      }
    }
  }
  return wish;
}

bool ContextFit::recorded_just_so(const Surroundings& asked, const Surroundings& own) const {
  return own.before == asked.before && own.after == asked.after &&
         std::abs(own.duration_s - asked.duration_s) < 0.5 / table_.rate_hz;
}

FitCost ContextFit::fit(const Wish& wish, NodeIndex node, bool ensured) const {
  FitCost cost;
  if (!wish.asks) {
    return cost;
  }
  const Surroundings& own = surroundings_[static_cast<std::size_t>(node)];
  if (!wish.target.empty() && !recorded_just_so(wish.surroundings, own)) {
    std::vector<float> made(ensured ? 0 : record_floats());
    if (!ensured) {
      fill_record(node, made.data());
    }
    const float* record = ensured ? records_[node] : made.data();
    cost.target =
        weights_.target * weights_.pnt *
        static_cast<double>(squared_distance(record, wish.target.data(), record_floats())) /
        static_cast<double>(kSamples);
  }
  if (weights_.context > 0.0) {
    const std::size_t phonemes = table_.phonemes.size();
    float sum = 0.0f;
    const float* row = wish.context.data();
    for (const auto* said : {&own.before, &own.after}) {
      for (const std::int32_t phoneme : *said) {
        sum += row[phoneme];
        row += phonemes;
      }
    }
    cost.context = weights_.context * weights_.pnt * static_cast<double>(sum);
  }
  const double asked_s = wish.surroundings.duration_s;
  cost.duration = weights_.duration * weights_.pnt * 2.0 * std::abs(own.duration_s - asked_s) /
                  (own.duration_s + asked_s);
  cost.position =
      weights_.position * weights_.pnt * std::abs(own.position - wish.surroundings.position);
  return cost;
}

} // namespace phonomime
