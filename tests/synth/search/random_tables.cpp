// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/synth/search/random_tables.h"

#include <algorithm>
#include <numeric>

#include <Eigen/QR>

namespace phonomime::test {

namespace {

void add_vocabulary(const TableShape& shape, MotionTable& table) {
  table.phonemes.push_back(
      {std::string(kSilence), std::string(kSilence), Visibility::intermediate});
  table.visemes.emplace_back(kSilence);
  for (int v = 0; v < shape.visemes; ++v) {
    table.visemes.push_back("v" + std::to_string(v));
  }
  for (int p = 0; p < shape.phonemes; ++p) {
    table.phonemes.push_back({"p" + std::to_string(p), "v" + std::to_string(p % shape.visemes),
                              static_cast<Visibility>(p % 3)});
  }
  for (int e = 0; e < shape.emotions; ++e) {
    table.emotions.push_back("e" + std::to_string(e));
  }
}

void add_layout(const TableShape& shape, MotionTable& table, Draw& draw) {
  table.layout.kind = shape.kind;
  for (int g = 0; g < shape.groups; ++g) {
    table.layout.groups.push_back({"m" + std::to_string(g), {}});
    if (g < shape.lips) {
      table.layout.groups.back().regions = {Region::lips};
    }
  }
  const int channels = table.layout.channel_count();
  Eigen::MatrixXd random(channels, shape.dimensions);
  for (double& value : random.reshaped()) {
    value = draw.symmetric();
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(random);
  table.pca.basis = qr.householderQ() * Eigen::MatrixXd::Identity(channels, shape.dimensions);
  table.pca.mean = Eigen::VectorXd::LinSpaced(channels, -20.0, 30.0);
  table.pca.variance = Eigen::VectorXd::LinSpaced(shape.dimensions, 4.0, 1.0);
  table.reference_pose = table.pca.mean;
  table.rate_hz = 100.0;
}

} // namespace

MotionTable random_table(const TableShape& shape, Draw& draw) {
  MotionTable table;
  add_vocabulary(shape, table);
  add_layout(shape, table, draw);
  std::vector<Eigen::VectorXd> frames;
  std::size_t previous_begin = 0;
  for (int s = 0; s < shape.sentences; ++s) {
    const auto emotion = draw.below(shape.emotions);
    const std::string emotion_name = table.emotions[static_cast<std::size_t>(emotion)];
    table.sentences.push_back({"s", emotion_name, "u" + std::to_string(s), ""});
    const bool duplicate = s > 0 && draw.chance(shape.duplicate_chance);
    const std::size_t begin = table.nodes.size();
    const int length = duplicate ? static_cast<int>(begin - previous_begin)
                                 : 1 + draw.below(shape.longest_sentence);
    NodeIndex before = kNoNode;
    int order = 0;
    Eigen::VectorXd pose = Eigen::VectorXd::Zero(shape.dimensions);
    Eigen::VectorXd velocity = Eigen::VectorXd::Zero(shape.dimensions);
    for (int i = 0; i < length; ++i) {
      const MotionNode* original =
          duplicate ? &table.nodes[previous_begin + static_cast<std::size_t>(i)] : nullptr;
      const bool pause =
          original ? original->predecessor == kNoNode && i > 0 : i > 0 && draw.chance(0.15);
      if (pause) {
        before = kNoNode;
        ++order;
      }
      MotionNode node;
      node.phoneme = original ? original->phoneme : 1 + draw.below(shape.phonemes);
      node.viseme =
          *table.find_viseme(table.phonemes[static_cast<std::size_t>(node.phoneme)].viseme);
      node.emotion = emotion;
      node.sentence = s;
      node.order = order++;
      node.predecessor = before;
      node.frame_count = original ? original->frame_count : 1 + draw.below(6);
      node.first_frame = static_cast<std::int64_t>(frames.size());
      for (int f = 0; f < node.frame_count; ++f) {
        if (original) {
          frames.push_back(frames[static_cast<std::size_t>(original->first_frame + f)]);
          continue;
        }
        for (double& v : velocity) {
          v = 0.8 * v + 0.3 * draw.symmetric();
        }
        pose = 0.97 * pose + velocity;
        frames.push_back(pose);
      }
      if (before != kNoNode) {
        table.nodes[static_cast<std::size_t>(before)].successor = table.node_count();
      }
      before = table.node_count();
      table.nodes.push_back(node);
    }
    previous_begin = begin;
  }
  table.coefficients.resize(static_cast<Eigen::Index>(frames.size()), shape.dimensions);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    table.coefficients.row(static_cast<Eigen::Index>(f)) = frames[f].transpose().cast<float>();
  }
  return table;
}

std::vector<SearchStep> random_steps(const MotionTable& table, int length, Draw& draw,
                                     double constraint_chance, double pause_chance) {
  std::vector<SearchStep> steps;
  const int n = table.node_count();
  for (int t = 0; t < length; ++t) {
    SearchStep step;
    step.emotion = draw.below(static_cast<int>(table.emotions.size()) + 1) - 1;
    if (t > 0 && t + 1 < length && draw.chance(pause_chance)) {
      step.is_silence = true;
    } else if (draw.chance(0.1)) {
      step.phoneme = -1;
      step.viseme = draw.below(static_cast<int>(table.visemes.size()));
    } else {
      step.phoneme = 1 + draw.below(static_cast<int>(table.phonemes.size()) - 1);
      step.viseme =
          *table.find_viseme(table.phonemes[static_cast<std::size_t>(step.phoneme)].viseme);
    }
    if (draw.chance(constraint_chance)) {
      for (int k = 1 + draw.below(3); k > 0; --k) {
        step.allowed.push_back(draw.below(n));
      }
    }
    if (draw.chance(constraint_chance)) {
      for (int k = 1 + draw.below(std::max(1, n / 4)); k > 0; --k) {
        step.avoided.push_back(draw.below(n));
      }
    }
    for (std::vector<NodeIndex>* set : {&step.allowed, &step.avoided}) {
      std::ranges::sort(*set);
      set->erase(std::unique(set->begin(), set->end()), set->end());
    }
    const auto banned = [&](NodeIndex node) {
      return std::ranges::binary_search(step.avoided, node);
    };
    if (!step.allowed.empty() && std::ranges::all_of(step.allowed, banned)) {
      step.avoided.clear();
    }
    if (static_cast<int>(step.avoided.size()) >= n) {
      step.avoided.clear();
    }
    steps.push_back(step);
  }
  return steps;
}

CostWeights random_weights(Draw& draw) {
  const auto weight = [&](double largest) {
    return draw.chance(0.15) ? 0.0 : largest * draw.unit() * draw.unit();
  };
  CostWeights weights;
  weights.alpha1 = weight(2.0);
  weights.alpha2 = weight(0.5);
  weights.alpha3 = weight(40.0);
  weights.alpha4 = 0.05 + 0.9 * draw.unit();
  weights.alpha5 = weight(12.0);
  weights.alpha6 = weight(12.0);
  weights.pnt = weight(400.0);
  return weights;
}

std::vector<NodeIndex> all_nodes(const MotionTable& table) {
  std::vector<NodeIndex> nodes(table.nodes.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

} // namespace phonomime::test
