// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/rig.h"

#include "db/types/errors.h"
#include "db/types/json_file.h"
#include "db/types/text.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

namespace phonomime {
namespace {

using Json = nlohmann::json;

RigTarget target_of(const std::string& name) {
  const auto found = std::ranges::find(kRigTargetNames, name);
  return static_cast<RigTarget>(found - kRigTargetNames.begin());
}

Eigen::Quaterniond rotation_of(const Json& json, const std::string& node,
                               const std::string& keyshape, std::string_view where) {
  const Eigen::Quaterniond rotation(json[3].get<double>(), json[0].get<double>(),
                                    json[1].get<double>(), json[2].get<double>());
  if (std::abs(rotation.norm() - 1.0) > 1e-3) {
    throw InputError({.where = std::string(where),
                      .what = "keyshape " + quoted(keyshape) + ": the rotation of " + quoted(node) +
                              " is no unit quaternion",
                      .expected = "[x, y, z, w] of length 1",
                      .got = "length " + format_number(rotation.norm())});
  }
  // One that is already of length 1 keeps its bits, however often it is written and read.
  return std::abs(rotation.norm() - 1.0) < 1e-12 ? rotation : rotation.normalized();
}

RigKeyshape keyshape_of(const Json& json, RigTarget target, std::string_view where) {
  RigKeyshape keyshape;
  keyshape.name = json["name"].get<std::string>();
  keyshape.source = json["source"].get<int>();
  const std::array<const char*, 4> members = {"weights", "file", "rotations", "file"};
  const std::string member = members[static_cast<std::size_t>(target)];
  for (const char* other : {"weights", "file", "rotations"}) {
    if ((other == member) != json.contains(other)) {
      throw InputError({.where = std::string(where),
                        .what = "keyshape " + quoted(keyshape.name) + " does not say what the " +
                                std::string(kRigTargetNames[static_cast<std::size_t>(target)]) +
                                " of the target do",
                        .expected = "the member " + quoted(member) + " alone",
                        .got = json.contains(other) ? quoted(other) : "none"});
    }
  }
  if (target == RigTarget::shapes) {
    for (const auto& [name, weight] : json["weights"].items()) {
      keyshape.weights[name] = weight.get<double>();
    }
  } else if (target == RigTarget::joints) {
    for (const auto& [name, rotation] : json["rotations"].items()) {
      keyshape.rotations[name] = rotation_of(rotation, name, keyshape.name, where);
    }
  } else {
    keyshape.file = json["file"].get<std::string>();
  }
  return keyshape;
}

void check(const Rig& rig, std::string_view where) {
  std::set<std::pair<std::string, std::string>> sets;
  for (const RigSet& set : rig.sets) {
    const std::string name = quoted(set.expression) + ", part " + quoted(set.part);
    if (!sets.insert({set.expression, set.part}).second) {
      throw InputError(
          {.where = std::string(where), .what = "expression " + name + " is there twice"});
    }
    std::set<std::string> names;
    for (const RigKeyshape& keyshape : set.keyshapes) {
      if (!names.insert(keyshape.name).second) {
        throw InputError(
            {.where = std::string(where),
             .what = "expression " + name + " has two keyshapes " + quoted(keyshape.name)});
      }
    }
  }
  if (rig.seam && !(rig.seam->from < rig.seam->to)) {
    throw InputError({.where = std::string(where),
                      .what = "the seam ends below its start",
                      .expected = "from < to"});
  }
  if (rig.target != RigTarget::shapes && rig.file.empty()) {
    throw InputError({.where = std::string(where),
                      .what = "the rig names no file of its target at rest",
                      .remedy = "Give it as \"file\"."});
  }
}

} // namespace

Rig parse_rig(std::string_view json_text, std::string_view where) {
  const Json json = parse_json_as("rig", json_text, where);
  Rig rig;
  rig.target = target_of(json["target"].get<std::string>());
  rig.file = json.value("file", std::string());
  rig.source = json["source"].get<std::string>();
  if (json.contains("seam")) {
    rig.seam = {json["seam"]["from"].get<double>(), json["seam"]["to"].get<double>()};
  }
  for (const Json& entry : json["sets"]) {
    RigSet set;
    set.expression = entry.value("expression", set.expression);
    set.part = entry.value("part", set.part);
    for (const Json& keyshape : entry["keyshapes"]) {
      set.keyshapes.push_back(keyshape_of(keyshape, rig.target, where));
    }
    rig.sets.push_back(std::move(set));
  }
  check(rig, where);
  return rig;
}

std::string format_rig(const Rig& rig) {
  nlohmann::ordered_json json;
  json["rig"] = 1;
  json["target"] = kRigTargetNames[static_cast<std::size_t>(rig.target)];
  if (!rig.file.empty()) {
    json["file"] = rig.file;
  }
  json["source"] = rig.source;
  if (rig.seam) {
    json["seam"] = {{"from", rig.seam->from}, {"to", rig.seam->to}};
  }
  json["sets"] = nlohmann::ordered_json::array();
  for (const RigSet& set : rig.sets) {
    nlohmann::ordered_json entry = {{"expression", set.expression}, {"part", set.part}};
    entry["keyshapes"] = nlohmann::ordered_json::array();
    for (const RigKeyshape& keyshape : set.keyshapes) {
      nlohmann::ordered_json one = {{"name", keyshape.name}, {"source", keyshape.source}};
      if (rig.target == RigTarget::shapes) {
        one["weights"] = nlohmann::ordered_json::object();
        for (const auto& [name, weight] : keyshape.weights) {
          one["weights"][name] = weight;
        }
      } else if (rig.target == RigTarget::joints) {
        one["rotations"] = nlohmann::ordered_json::object();
        for (const auto& [name, q] : keyshape.rotations) {
          one["rotations"][name] = {q.x(), q.y(), q.z(), q.w()};
        }
      } else {
        one["file"] = keyshape.file;
      }
      entry["keyshapes"].push_back(std::move(one));
    }
    json["sets"].push_back(std::move(entry));
  }
  return json.dump(1) + "\n";
}

} // namespace phonomime
