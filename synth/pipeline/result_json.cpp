// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/result_json.h"

#include "synth/pipeline/closures.h"

#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

nlohmann::ordered_json row_to_json(const MotionTable& table, const PathRow& row,
                                   std::size_t index) {
  nlohmann::ordered_json json;
  json["index"] = index;
  json["phoneme"] = row.phoneme.phoneme.name;
  json["start"] = row.phoneme.start_s;
  json["end"] = row.phoneme.end_s;
  json["emotion"] = row.emotion;
  json["node"] = nullptr;
  json["captured"] = row.captured;
  json["constrained"] = row.constrained;
  if (row.node != kNoNode) {
    const MotionNode& node = table.nodes[static_cast<std::size_t>(row.node)];
    json["node"] = table.key(row.node);
    json["recorded"] = {{"phoneme", table.phonemes[static_cast<std::size_t>(node.phoneme)].name},
                        {"emotion", table.emotions[static_cast<std::size_t>(node.emotion)]},
                        {"frames", node.frame_count}};
    if (const std::optional<bool> closed = recorded_closed(table, row.node)) {
      json["recorded"]["closed"] = *closed;
    }
  }
  if (row.asked) {
    json["asked"] = format_emotions(*row.asked);
  }
  json["cost"] = {{"observation", row.cost.observation}, {"emotion", row.cost.emotion},
                  {"transition", row.cost.transition},   {"target", row.cost.fit.target},
                  {"context", row.cost.fit.context},     {"duration", row.cost.fit.duration},
                  {"position", row.cost.fit.position}};
  json["runners_up"] = nlohmann::ordered_json::array();
  for (const RunnerUp& other : row.runners_up) {
    json["runners_up"].push_back({{"node", table.key(other.node)}, {"delta", other.delta}});
  }
  return json;
}

} // namespace

nlohmann::ordered_json result_to_json(const MotionTable& table, const SynthesisResult& result) {
  nlohmann::ordered_json json;
  json["format"] = "phonomime-result";
  json["version"] = 1;
  json["speaker"] = table.speaker;
  json["synthetic"] = table.synthetic;
  json["duration"] = result.end_s;
  json["fps"] = result.output.rate_hz;
  json["frames"] = result.output.coefficients.rows();
  json["cost"] = result.cost;
  json["path"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < result.rows.size(); ++i) {
    json["path"].push_back(row_to_json(table, result.rows[i], i));
  }
  json["weight"] = result.weight;
  json["expected_weight"] = result.expected_weight;
  json["blend"] = nlohmann::ordered_json::array();
  for (const BlendedPath& path : result.blended) {
    nlohmann::ordered_json nodes = nlohmann::ordered_json::array();
    for (const NodeIndex node : path.nodes) {
      nodes.push_back(node == kNoNode ? nlohmann::ordered_json()
                                      : nlohmann::ordered_json(table.key(node)));
    }
    json["blend"].push_back({{"weight", path.weight}, {"cost", path.cost}, {"nodes", nodes}});
  }
  if (result.style) {
    json["style"] = {{"change", result.style->change},
                     {"contacts", result.style->contacts},
                     {"contacts_moved", result.style->contacts_moved},
                     {"contacts_left", result.style->contacts_left}};
  }
  json["search"] = {{"nodes", table.nodes.size()},
                    {"seconds", result.search_seconds},
                    {"transitions", result.counts.transitions},
                    {"bounds", result.counts.bounds},
                    {"states", result.counts.states}};
  json["warnings"] = result.warnings;
  return json;
}

} // namespace phonomime
