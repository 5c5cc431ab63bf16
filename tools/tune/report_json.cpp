// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/text_table.h"
#include "tools/tune/tuning.h"

#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json gain_to_json(const Scores& scores, Measure objective) {
  const Gain gain = gain_of(scores, objective);
  return {{"sentences", gain.sentences},
          {"shipped", number(gain.shipped)},
          {"tuned", number(gain.tuned)},
          {"gain", number(gain.gain)},
          {"standard_error", number(gain.standard_error)},
          {"better", gain.better},
          {"worse", gain.worse},
          {"p", gain.p_value}};
}

Json scores_to_json(const Scores& scores, Measure objective) {
  Json json = gain_to_json(scores, objective);
  json["values"] = Json::array();
  for (std::size_t i = 0; i < scores.keys.size(); ++i) {
    json["values"].push_back({{"key", scores.keys[i]},
                              {"shipped", number(scores.shipped[i])},
                              {"tuned", number(scores.tuned[i])}});
  }
  return json;
}

Json part_to_json(const TunedPart& part, Measure objective) {
  Json json;
  json["fold"] = part.fold;
  json["weights"] = Json::parse(weights_line(part.tuned));
  json["inner"] = scores_to_json(part.inner, objective);
  json["held_out"] = part.fold > 0 ? scores_to_json(part.held_out, objective) : Json(nullptr);
  json["looks"] = Json::array();
  for (const EvaluatedWeights& look : part.looks) {
    json["looks"].push_back(
        {{"weights", Json::parse(weights_line(look.weights))}, {"value", look.value}});
  }
  return json;
}

constexpr std::array<std::string_view, 3> kVerdictNames = {"better", "worse", "no difference"};

} // namespace

std::string tuning_json(const Tuning& tuning) {
  const MeasureInfo& measure = info(tuning.objective);
  Json json;
  json["format"] = "phonomime-tuning";
  json["version"] = 1;
  json["corpus"] = tuning.corpus;
  json["options"] = tuning.options;
  json["notes"] = tuning.notes;
  json["objective"] = {{"id", measure.id},
                       {"label", measure.label},
                       {"unit", unit_of(tuning.objective, tuning.kind)},
                       {"formula", measure.formula},
                       {"mask", measure.mask}};
  json["weights"] = Json::array();
  for (const TunableWeight& weight : tuning.weights) {
    json["weights"].push_back({{"name", weight.name},
                               {"least", weight.least},
                               {"most", weight.most},
                               {"shipped", tuning.shipped.*weight.member},
                               {"tuned", tuning.all.tuned.*weight.member}});
  }
  json["shipped"] = Json::parse(weights_line(tuning.shipped));
  json["all"] = part_to_json(tuning.all, tuning.objective);
  json["folds"] = Json::array();
  for (const TunedPart& fold : tuning.folds) {
    json["folds"].push_back(part_to_json(fold, tuning.objective));
  }
  json["inner"] = gain_to_json(inner_scores(tuning), tuning.objective);
  json["held_out"] = gain_to_json(held_out_scores(tuning), tuning.objective);
  json["verdict"] = kVerdictNames.at(static_cast<std::size_t>(verdict_of(tuning)));
  json["out_of_time"] = tuning.out_of_time;
  return json.dump(1) + "\n";
}

std::string tuned_weights_file(const Tuning& tuning) {
  Json json = {{"format", "phonomime-weights"}, {"version", 1}};
  json.update(Json::parse(weights_line(tuning.all.tuned)));
  const int decimals = info(tuning.objective).decimals + 2;
  const Gain held_out = gain_of(held_out_scores(tuning), tuning.objective);
  json["x-tuned"] = {
      {"corpus", tuning.corpus},
      {"objective", info(tuning.objective).id},
      {"options", tuning.options},
      {"held_out", fmt::format("shipped {}, tuned {}, gain {} (p = {:.2g})",
                               shown(held_out.shipped, decimals), shown(held_out.tuned, decimals),
                               shown(held_out.gain, decimals), held_out.p_value)}};
  return json.dump(1) + "\n";
}

} // namespace phonomime
