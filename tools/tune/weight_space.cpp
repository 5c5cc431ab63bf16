// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tune/weight_space.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "synth/search/cost_weights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

// The ranges are about ten times the shipped weights to either side (docs/tune.md).
constexpr std::array kTunable = {
    TunableWeight{"alpha1", &CostWeights::alpha1, 0.5, 8.0, false, true},
    TunableWeight{"alpha2", &CostWeights::alpha2, 0.02, 2.0, false, true},
    TunableWeight{"alpha3", &CostWeights::alpha3, 2.0, 200.0, false, true},
    TunableWeight{"alpha4", &CostWeights::alpha4, 0.1, 0.9, false, true},
    TunableWeight{"alpha5", &CostWeights::alpha5, 2.0, 40.0, false, true},
    TunableWeight{"alpha6", &CostWeights::alpha6, 2.0, 40.0, false, true},
    TunableWeight{"target", &CostWeights::target, 0.1, 4.0, true, true},
    TunableWeight{"context", &CostWeights::context, 0.1, 6.0, true, true},
    TunableWeight{"duration", &CostWeights::duration, 0.03, 3.0, true, true},
    TunableWeight{"position", &CostWeights::position, 0.01, 1.0, true, false},
    TunableWeight{"off_lips", &CostWeights::off_lips, 0.1, 1.0, true, true}};

double rounded(double value) {
  return *parse_number(fmt::format("{:.3g}", value));
}

const TunableWeight& find_weight(const std::string& name) {
  const auto found = std::ranges::find(kTunable, std::string_view(name), &TunableWeight::name);
  if (found == kTunable.end()) {
    std::vector<std::string> known;
    for (const TunableWeight& weight : kTunable) {
      known.emplace_back(weight.name);
    }
    throw UsageError({.where = "--only",
                      .what = fmt::format("there is no weight {} to tune", quoted(name)),
                      .expected = fmt::format("some of {}", fmt::join(known, ", ")),
                      .remedy = did_you_mean(name, known)});
  }
  return *found;
}

} // namespace

std::span<const TunableWeight> tunable_weights() {
  return kTunable;
}

WeightSpace::WeightSpace(CostModel model, std::span<const std::string> names,
                         bool several_emotions) {
  const auto has = [&](const TunableWeight& weight) {
    return model == CostModel::context || !weight.beyond_paper;
  };
  const auto matters = [&](const TunableWeight& weight) {
    return weight.member != &CostWeights::alpha6 || several_emotions;
  };
  if (names.empty()) {
    std::ranges::copy_if(kTunable, std::back_inserter(weights_), [&](const TunableWeight& weight) {
      return weight.usual && has(weight) && matters(weight);
    });
  }
  for (const std::string& name : names) {
    const TunableWeight& weight = find_weight(name);
    const auto refuse = [&](std::string what, std::string remedy) {
      throw UsageError({.where = "--only", .what = std::move(what), .remedy = std::move(remedy)});
    };
    if (std::ranges::find(weights_, weight.name, &TunableWeight::name) != weights_.end()) {
      refuse(quoted(name) + " is named twice", "");
    }
    if (!has(weight)) {
      refuse(fmt::format("the paper's cost has no {}", name), "Tune it with --cost context.");
    }
    if (!matters(weight)) {
      refuse("alpha6 changes nothing: all recordings are of one emotion", "Leave it out.");
    }
    weights_.push_back(weight);
  }
}

std::vector<double> WeightSpace::point(const CostWeights& weights) const {
  std::vector<double> point;
  for (const TunableWeight& weight : weights_) {
    const double value = std::clamp(weights.*weight.member, weight.least, weight.most);
    point.push_back(std::log(value / weight.least) / std::log(weight.most / weight.least));
  }
  return point;
}

CostWeights WeightSpace::at(std::span<const double> point, const CostWeights& base) const {
  CostWeights weights = base;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const TunableWeight& weight = weights_[i];
    const double value =
        weight.least * std::pow(weight.most / weight.least, std::clamp(point[i], 0.0, 1.0));
    weights.*weight.member = std::clamp(rounded(value), weight.least, weight.most);
  }
  return weights;
}

std::string weights_line(const CostWeights& weights) {
  auto json = nlohmann::ordered_json::parse(format_cost_weights(weights));
  for (const char* name : {"format", "version", "pnt"}) {
    json.erase(name);
  }
  return json.dump();
}

CostWeights parse_weights_line(std::string_view line, std::string_view where) {
  CostWeights none;
  none.alpha4 = 0.5; // 0 is outside its range
  return parse_cost_weights(line, where, none);
}

} // namespace phonomime
