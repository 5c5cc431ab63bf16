// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/cost_weights.h"

#include "db/types/errors.h"
#include "db/types/json_file.h"
#include "db/types/text.h"
#include "synth/search/join_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

struct NamedWeight {
  const char* name;
  double CostWeights::*member;
};
constexpr std::array<NamedWeight, 12> kNamedWeights = {{{"alpha1", &CostWeights::alpha1},
                                                        {"alpha2", &CostWeights::alpha2},
                                                        {"alpha3", &CostWeights::alpha3},
                                                        {"alpha4", &CostWeights::alpha4},
                                                        {"alpha5", &CostWeights::alpha5},
                                                        {"alpha6", &CostWeights::alpha6},
                                                        {"pnt", &CostWeights::pnt},
                                                        {"target", &CostWeights::target},
                                                        {"context", &CostWeights::context},
                                                        {"duration", &CostWeights::duration},
                                                        {"position", &CostWeights::position},
                                                        {"off_lips", &CostWeights::off_lips}}};

} // namespace

CostWeights default_cost_weights(const MotionTable& table, CostModel model) {
  // Markers: a gap of 1 mm counts like a change of velocity of 20 mm/s (what it takes to close the
  // gap within 50 ms). Blendshape weights move on the same time scale. Phoneme and emotion are
  // asked for by the user: missing either costs more than several bad joins.
  CostWeights weights;
  weights.alpha1 = 1.0;
  weights.alpha2 = 0.2;
  weights.alpha3 = 20.0;
  weights.alpha4 = 0.4;
  weights.alpha5 = 10.0;
  weights.alpha6 = 10.0;
  if (model == CostModel::context) {
    // Found on grid_s1 by cross-validation, see docs/cost.md.
    weights.target = 0.6;
    weights.context = 1.0;
    weights.duration = 0.3;
    weights.position = 0.0;
    weights.off_lips = 0.5;
  }
  weights.pnt = median_ordinary_join(table, weights);
  return weights;
}

double median_ordinary_join(const MotionTable& table, const CostWeights& weights) {
  constexpr std::size_t kSample = 512;
  // Ends and starts at fixed strides through the table, paired where rule 2 would apply.
  std::vector<std::vector<NodeIndex>> ends_by_viseme(table.visemes.size());
  std::vector<NodeIndex> starts;
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    const MotionNode& info = table.nodes[static_cast<std::size_t>(node)];
    ends_by_viseme[static_cast<std::size_t>(info.viseme)].push_back(node);
    if (info.predecessor != kNoNode) {
      starts.push_back(node);
    }
  }
  const std::size_t stride = std::max<std::size_t>(1, starts.size() / kSample);
  std::vector<std::pair<NodeIndex, NodeIndex>> pairs;
  std::vector<NodeIndex> touched;
  for (std::size_t i = 0; i < starts.size(); i += stride) {
    const NodeIndex before = table.nodes[static_cast<std::size_t>(starts[i])].predecessor;
    const auto viseme =
        static_cast<std::size_t>(table.nodes[static_cast<std::size_t>(before)].viseme);
    const std::vector<NodeIndex>& ends = ends_by_viseme[viseme];
    const NodeIndex from = ends[(i * 7919) % ends.size()];
    if (from != before) {
      pairs.emplace_back(from, starts[i]);
      touched.push_back(from);
      touched.push_back(starts[i]);
    }
  }
  if (pairs.empty()) {
    return 1.0;
  }
  JoinCost cost(table, weights);
  cost.ensure(touched);
  std::vector<double> joins;
  for (const auto& [from, to] : pairs) {
    joins.push_back(cost.ordinary_join(from, to));
  }
  const auto middle = joins.begin() + static_cast<std::ptrdiff_t>(joins.size() / 2);
  std::ranges::nth_element(joins, middle);
  return *middle;
}

void check_cost_weights(const CostWeights& weights, std::string_view where) {
  for (const NamedWeight& weight : kNamedWeights) {
    const double value = weights.*weight.member;
    if (!std::isfinite(value) || value < 0.0) {
      throw InputError({.where = std::string(where),
                        .what = fmt::format("{} is out of range", weight.name),
                        .expected = "a finite number of at least 0",
                        .got = format_number(value)});
    }
  }
  if (weights.alpha4 <= 0.0 || weights.alpha4 >= 1.0) {
    throw InputError({.where = std::string(where),
                      .what = "alpha4 is out of range",
                      .expected = "a number between 0 and 1, both excluded",
                      .got = format_number(weights.alpha4)});
  }
  if (weights.off_lips > 1.0) {
    throw InputError({.where = std::string(where),
                      .what = "off_lips is out of range",
                      .expected = "a number from 0 to 1",
                      .got = format_number(weights.off_lips)});
  }
}

CostWeights parse_cost_weights(std::string_view json_text, std::string_view where,
                               const CostWeights& defaults) {
  const nlohmann::json json = parse_json_as("weights", json_text, where);
  CostWeights weights = defaults;
  for (const NamedWeight& weight : kNamedWeights) {
    if (json.contains(weight.name)) {
      weights.*weight.member = json.at(weight.name).get<double>();
    }
  }
  check_cost_weights(weights, where);
  return weights;
}

std::string format_cost_weights(const CostWeights& weights) {
  nlohmann::ordered_json json;
  json["format"] = "phonomime-weights";
  json["version"] = 1;
  for (const NamedWeight& weight : kNamedWeights) {
    json[weight.name] = weights.*weight.member;
  }
  return json.dump(1) + "\n";
}

} // namespace phonomime
