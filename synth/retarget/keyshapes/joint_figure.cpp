// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/joint_figure.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "synth/retarget/glb_container.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {
namespace {

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
  GlbContainer file;

  const nlohmann::ordered_json& nodes() const { return file.json["nodes"]; }
  std::size_t find_node(const std::string& name) const;
  Eigen::Quaterniond rest(std::size_t node) const;
  std::vector<std::string> turned(const RigTargets& targets) const;
  // Of one frame: a rotation for each node that turns, the one nearest to that before.
  std::vector<Eigen::Quaterniond> rotations(const std::vector<Eigen::Quaterniond>& at_rest,
                                            const Eigen::Ref<const Eigen::RowVectorXd>& values,
                                            std::vector<Eigen::Quaterniond> before) const;
};

JointFigure::JointFigure(const std::string& glb, std::string where)
    : impl_(std::make_unique<Impl>()) {
  impl_->where = std::move(where);
  impl_->file = parse_glb_container(glb, impl_->where);
  if (!impl_->file.json.contains("nodes")) {
    throw InputError({.where = impl_->where,
                      .what = "the file has no list of nodes",
                      .expected = "a figure of nodes that turn"});
  }
}

JointFigure::JointFigure(JointFigure&&) noexcept = default;
JointFigure::~JointFigure() = default;

std::vector<std::string> JointFigure::nodes() const {
  std::vector<std::string> names;
  for (const nlohmann::ordered_json& node : impl_->nodes()) {
    const bool named = node.contains("name") && node["name"].is_string();
    names.push_back(named ? node["name"].get<std::string>() : std::string());
  }
  return names;
}

std::size_t JointFigure::Impl::find_node(const std::string& name) const {
  std::vector<std::size_t> found;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < nodes().size(); ++i) {
    const nlohmann::ordered_json& node = nodes()[i];
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
  const nlohmann::ordered_json& node = nodes()[index];
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
    throw InputError({.where = where, .what = "the rotation of a node is no quaternion"});
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

std::string JointFigure::animated(const RigTargets& targets, const FrameMatrixD& motion,
                                  double rate_hz) const {
  GlbContainer file = impl_->file;
  const std::vector<std::string> names = impl_->turned(targets);
  std::vector<Eigen::Quaterniond> rest;
  for (const std::string& name : names) {
    rest.push_back(impl_->rest(impl_->find_node(name)));
  }
  std::vector<std::vector<float>> samples(names.size());
  std::vector<Eigen::Quaterniond> now = rest;
  for (Eigen::Index t = 0; t < motion.rows(); ++t) {
    now = impl_->rotations(rest, motion.row(t), std::move(now));
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
  if (!names.empty() && motion.rows() > 0) {
    const std::size_t times = file.add_times(static_cast<std::size_t>(motion.rows()), rate_hz);
    for (std::size_t i = 0; i < names.size(); ++i) {
      animation["samplers"].push_back({{"input", times},
                                       {"output", file.add(samples[i], "VEC4", 4)},
                                       {"interpolation", "LINEAR"}});
      animation["channels"].push_back(
          {{"sampler", i},
           {"target", {{"node", impl_->find_node(names[i])}, {"path", "rotation"}}}});
    }
    file.json["animations"].push_back(std::move(animation));
  }
  return file.bytes();
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
