// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/joint_figure.h"

#include "db/types/errors.h"
#include "db/types/json_file.h"
#include "db/types/text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {
namespace {

constexpr std::size_t kHeader = 12;
constexpr std::size_t kChunkHeader = 8;
constexpr std::uint32_t kJson = 0x4E4F534A;
constexpr std::uint32_t kBinary = 0x004E4942;

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

void append_number(std::string& bytes, std::uint32_t value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

void append_chunk(std::string& bytes, std::uint32_t type, std::string chunk, char filler) {
  while (chunk.size() % 4 != 0) {
    chunk += filler;
  }
  append_number(bytes, static_cast<std::uint32_t>(chunk.size()));
  append_number(bytes, type);
  bytes += chunk;
}

Eigen::Vector3d logarithm(const Eigen::Quaterniond& q) {
  const Eigen::AngleAxisd turn(q); // angle 0 to pi
  return turn.angle() * turn.axis();
}

Eigen::Quaterniond exponential(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  return angle == 0.0 ? Eigen::Quaterniond::Identity()
                      : Eigen::Quaterniond(Eigen::AngleAxisd(angle, v / angle));
}

} // namespace

struct JointFigure::Impl {
  std::string where;
  nlohmann::ordered_json json;
  std::string binary; // without its chunk header

  InputError error(const std::string& what, const std::string& remedy = {}) const {
    return InputError(
        {.where = where, .what = what, .expected = "binary glTF 2.0", .remedy = remedy});
  }
  std::size_t find_node(const std::string& name) const;
  Eigen::Quaterniond rest(std::size_t node) const;
  std::vector<std::string> turned(const RigTargets& targets) const;
  // Of one frame: a rotation for each node that turns, the one nearest to that before.
  std::vector<Eigen::Quaterniond> rotations(const std::vector<Eigen::Quaterniond>& at_rest,
                                            const Eigen::Ref<const Eigen::RowVectorXd>& values,
                                            std::vector<Eigen::Quaterniond> before) const;
  int add_accessor(const std::vector<float>& values, int width, const char* type, bool range);
};

JointFigure::JointFigure(std::string glb, std::string where) : impl_(std::make_unique<Impl>()) {
  impl_->where = std::move(where);
  const std::string_view bytes = glb;
  if (bytes.size() < kHeader + kChunkHeader || !bytes.starts_with("glTF") ||
      number_at(bytes, 4) != 2 || number_at(bytes, kHeader + 4) != kJson) {
    throw impl_->error("the file is no binary glTF");
  }
  const std::size_t json_size = number_at(bytes, kHeader);
  const std::size_t json_end = kHeader + kChunkHeader + json_size;
  if (json_end > bytes.size()) {
    throw impl_->error("the file ends early");
  }
  impl_->json = nlohmann::ordered_json(
      parse_json(bytes.substr(kHeader + kChunkHeader, json_size), impl_->where));
  if (json_end + kChunkHeader <= bytes.size() && number_at(bytes, json_end + 4) == kBinary) {
    const std::size_t size = number_at(bytes, json_end);
    if (json_end + kChunkHeader + size > bytes.size()) {
      throw impl_->error("the file ends early");
    }
    impl_->binary = bytes.substr(json_end + kChunkHeader, size);
  }
  const auto has_list = [&](const char* member) {
    return !impl_->json.contains(member) || impl_->json[member].is_array();
  };
  if (!impl_->json.is_object() || !has_list("nodes") || !has_list("buffers") ||
      !has_list("bufferViews") || !has_list("accessors") || !has_list("animations") ||
      !impl_->json.contains("nodes")) {
    throw impl_->error("the file has no list of nodes");
  }
  for (const nlohmann::ordered_json& node : impl_->json["nodes"]) {
    if (!node.is_object()) {
      throw impl_->error("a node is no object");
    }
  }
  if (impl_->json.contains("buffers") && !impl_->json["buffers"].empty() &&
      (!impl_->json["buffers"][0].is_object() || impl_->json["buffers"][0].contains("uri"))) {
    throw impl_->error("the file keeps its numbers in another file", "Export it as a single .glb.");
  }
}

JointFigure::JointFigure(JointFigure&&) noexcept = default;
JointFigure::~JointFigure() = default;

std::vector<std::string> JointFigure::nodes() const {
  std::vector<std::string> names;
  for (const nlohmann::ordered_json& node : impl_->json["nodes"]) {
    const bool named = node.contains("name") && node["name"].is_string();
    names.push_back(named ? node["name"].get<std::string>() : std::string());
  }
  return names;
}

std::size_t JointFigure::Impl::find_node(const std::string& name) const {
  std::vector<std::size_t> found;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < json["nodes"].size(); ++i) {
    const nlohmann::ordered_json& node = json["nodes"][i];
    if (node.contains("name") && node["name"].is_string()) {
      names.push_back(node["name"].get<std::string>());
      if (names.back() == name) {
        found.push_back(i);
      }
    }
  }
  if (found.size() != 1) {
    throw InputError({.where = where,
                      .what = (found.empty() ? "the figure has no node " : "two nodes are named ") +
                              quoted(name),
                      .remedy = found.empty() ? did_you_mean(name, names) : std::string()});
  }
  return found.front();
}

Eigen::Quaterniond JointFigure::Impl::rest(std::size_t index) const {
  const nlohmann::ordered_json& node = json["nodes"][index];
  if (node.contains("matrix")) {
    throw InputError({.where = where,
                      .what = "node " + quoted(node["name"].get<std::string>()) +
                              " is placed by a matrix and cannot turn",
                      .remedy = "Export it with translation, rotation and scale."});
  }
  if (!node.contains("rotation")) {
    return Eigen::Quaterniond::Identity();
  }
  const nlohmann::ordered_json& r = node["rotation"];
  const bool four = r.is_array() && r.size() == 4 &&
                    std::ranges::all_of(r, [](const auto& value) { return value.is_number(); });
  const Eigen::Quaterniond rotation =
      four ? Eigen::Quaterniond(r[3].get<double>(), r[0].get<double>(), r[1].get<double>(),
                                r[2].get<double>())
           : Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0);
  if (!(rotation.norm() > 0.5 && rotation.norm() < 2.0)) {
    throw error("the rotation of a node is no quaternion");
  }
  return rotation.normalized();
}

RigTargets JointFigure::targets(const Rig& rig) const {
  std::set<std::string> names;
  for (const RigSet& set : rig.sets) {
    for (const RigKeyshape& keyshape : set.keyshapes) {
      for (const auto& entry : keyshape.rotations) {
        names.insert(entry.first);
      }
    }
  }
  RigTargets targets;
  targets.values = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(keyshape_names(rig).size()),
                                         3 * static_cast<Eigen::Index>(names.size()));
  Eigen::Index column = 0;
  for (const std::string& name : names) {
    const Eigen::Quaterniond rest = impl_->rest(impl_->find_node(name));
    Eigen::Index row = 0;
    for (const RigSet& set : rig.sets) {
      for (const RigKeyshape& keyshape : set.keyshapes) {
        if (const auto found = keyshape.rotations.find(name); found != keyshape.rotations.end()) {
          targets.values.block<1, 3>(row, column) =
              logarithm(rest.conjugate() * found->second).transpose();
        }
        ++row;
      }
    }
    for (const char* axis : {".x", ".y", ".z"}) {
      targets.names.push_back(name + axis);
    }
    column += 3;
  }
  return targets;
}

std::vector<std::string> JointFigure::Impl::turned(const RigTargets& targets) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < targets.names.size(); i += 3) {
    names.push_back(targets.names[i].substr(0, targets.names[i].size() - 2));
  }
  return names;
}

std::vector<Eigen::Quaterniond>
JointFigure::Impl::rotations(const std::vector<Eigen::Quaterniond>& at_rest,
                             const Eigen::Ref<const Eigen::RowVectorXd>& values,
                             std::vector<Eigen::Quaterniond> before) const {
  for (std::size_t i = 0; i < at_rest.size(); ++i) {
    const Eigen::Vector3d v = values.segment<3>(3 * static_cast<Eigen::Index>(i)).transpose();
    Eigen::Quaterniond now = at_rest[i] * exponential(v);
    if (now.dot(before[i]) < 0.0) { // the same rotation, and programs interpolate the short way
      now.coeffs() *= -1.0;
    }
    before[i] = now;
  }
  return before;
}

int JointFigure::Impl::add_accessor(const std::vector<float>& values, int width, const char* type,
                                    bool range) {
  while (binary.size() % 4 != 0) {
    binary += '\0';
  }
  const std::size_t bytes = values.size() * sizeof(float);
  json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes}});
  binary.append(reinterpret_cast<const char*>(values.data()), bytes);
  nlohmann::ordered_json accessor = {{"bufferView", json["bufferViews"].size() - 1},
                                     {"componentType", 5126},
                                     {"count", values.size() / static_cast<std::size_t>(width)},
                                     {"type", type}};
  if (range) {
    accessor["min"] = {values.front()};
    accessor["max"] = {values.back()};
  }
  json["accessors"].push_back(std::move(accessor));
  return static_cast<int>(json["accessors"].size()) - 1;
}

std::string JointFigure::animated(const RigTargets& targets, const FrameMatrixD& motion,
                                  double rate_hz) const {
  Impl file = *impl_;
  const std::vector<std::string> names = file.turned(targets);
  for (const char* member : {"buffers", "bufferViews", "accessors", "animations"}) {
    if (!file.json.contains(member)) {
      file.json[member] = nlohmann::ordered_json::array();
    }
  }
  if (file.json["buffers"].empty()) {
    file.json["buffers"].push_back(nlohmann::ordered_json::object());
  }
  std::vector<Eigen::Quaterniond> rest;
  for (const std::string& name : names) {
    rest.push_back(file.rest(file.find_node(name)));
  }
  std::vector<float> times;
  std::vector<std::vector<float>> samples(names.size());
  std::vector<Eigen::Quaterniond> now = rest;
  for (Eigen::Index t = 0; t < motion.rows(); ++t) {
    times.push_back(static_cast<float>(static_cast<double>(t) / rate_hz));
    now = file.rotations(rest, motion.row(t), std::move(now));
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Eigen::Vector4d coefficients = now[i].coeffs(); // x, y, z, w, as glTF
      for (const double value : coefficients) {
        samples[i].push_back(static_cast<float>(value));
      }
    }
  }
  nlohmann::ordered_json animation = {{"name", "speech"},
                                      {"samplers", nlohmann::ordered_json::array()},
                                      {"channels", nlohmann::ordered_json::array()}};
  const int time_accessor = file.add_accessor(times, 1, "SCALAR", true);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int output = file.add_accessor(samples[i], 4, "VEC4", false);
    animation["samplers"].push_back(
        {{"input", time_accessor}, {"output", output}, {"interpolation", "LINEAR"}});
    animation["channels"].push_back(
        {{"sampler", i}, {"target", {{"node", file.find_node(names[i])}, {"path", "rotation"}}}});
  }
  if (!names.empty()) {
    file.json["animations"].push_back(std::move(animation));
  }
  file.json["buffers"][0]["byteLength"] = file.binary.size();
  std::string chunks;
  append_chunk(chunks, kJson, file.json.dump(), ' ');
  append_chunk(chunks, kBinary, file.binary, '\0');
  std::string glb = "glTF";
  append_number(glb, 2);
  append_number(glb, static_cast<std::uint32_t>(kHeader + chunks.size()));
  return glb + chunks;
}

std::string JointFigure::rotations_csv(const RigTargets& targets, const FrameMatrixD& motion,
                                       double rate_hz) const {
  const std::vector<std::string> names = impl_->turned(targets);
  std::string text = "time";
  std::vector<Eigen::Quaterniond> rest;
  for (const std::string& name : names) {
    rest.push_back(impl_->rest(impl_->find_node(name)));
    for (const char* part : {"_qx", "_qy", "_qz", "_qw"}) {
      text += "," + name + part;
    }
  }
  text += "\n";
  std::vector<Eigen::Quaterniond> now = rest;
  for (Eigen::Index t = 0; t < motion.rows(); ++t) {
    now = impl_->rotations(rest, motion.row(t), std::move(now));
    text += fmt::format("{:.4f}", static_cast<double>(t) / rate_hz);
    for (const Eigen::Quaterniond& q : now) {
      text += fmt::format(",{:.6f},{:.6f},{:.6f},{:.6f}", q.x(), q.y(), q.z(), q.w());
    }
    text += "\n";
  }
  return text;
}

} // namespace phonomime
