// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/shape_glb.h"

#include "db/types/errors.h"
#include "synth/retarget/glb_container.h"

#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

using Json = nlohmann::ordered_json;

void note(Json& json, const GlbNotes& notes) {
  json["asset"]["version"] = "2.0";
  json["asset"]["generator"] = "Phonomime";
  Json& extras = json["asset"]["extras"];
  if (!extras.is_object()) {
    extras = Json::object();
  }
  extras["title"] = notes.title;
  extras["credits"] = notes.credits;
  extras["synthetic"] = notes.synthetic;
}

// The names of a mesh's targets, as parse_face_scene has them.
std::vector<std::string> target_names(const Json& mesh, std::size_t index, std::size_t count) {
  std::vector<std::string> names;
  const Json given = mesh.contains("extras") && mesh["extras"].is_object()
                         ? mesh["extras"].value("targetNames", Json::array())
                         : Json::array();
  for (std::size_t k = 0; k < count; ++k) {
    std::string name =
        k < given.size() && given[k].is_string() ? given[k].get<std::string>() : std::string();
    names.push_back(name.empty() ? fmt::format("mesh{}_target{}", index, k) : std::move(name));
  }
  return names;
}

class Animation {
public:
  Animation(GlbContainer& container, const ShapeMotion& motion)
      : container_(container), motion_(motion) {
    times_ = container.add_times(static_cast<std::size_t>(motion.weights.frames.rows()),
                                 motion.weights.rate_hz);
    for (std::size_t g = 0; g < motion.weights.groups.size(); ++g) {
      column_.emplace(motion.weights.groups[g], static_cast<Eigen::Index>(g));
    }
    animation_ = {{"name", "speech"}, {"channels", Json::array()}, {"samplers", Json::array()}};
  }

  // Of a node that shows a mesh of these targets.
  void move_shapes(std::size_t node, const std::vector<std::string>& names) {
    std::vector<float> samples;
    for (Eigen::Index frame = 0; frame < motion_.weights.frames.rows(); ++frame) {
      for (const std::string& name : names) {
        const auto column = column_.find(name);
        samples.push_back(column == column_.end() ? 0.0F
                                                  : motion_.weights.frames(frame, column->second));
      }
    }
    container_.json["nodes"][node]["weights"] = std::vector<float>(
        samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(names.size()));
    add_channel(node, "weights", container_.add(samples, "SCALAR", 1));
  }

  void move_head(std::size_t node) {
    std::vector<float> turns;
    std::vector<float> places;
    Eigen::Vector4d before = Eigen::Vector4d::Zero();
    for (const HeadPose& head : motion_.head) {
      const FacePose pose = pose_on_face(head, motion_.placement);
      Eigen::Vector4d turn = pose.rotation.coeffs(); // x, y, z, w, as glTF
      if (turn.dot(before) < 0.0) {
        turn = -turn;
      }
      before = turn;
      for (const double value : turn) {
        turns.push_back(static_cast<float>(value));
      }
      for (const double value : pose.translation) {
        places.push_back(static_cast<float>(value));
      }
    }
    add_channel(node, "rotation", container_.add(turns, "VEC4", 4));
    add_channel(node, "translation", container_.add(places, "VEC3", 3));
  }

  Json json() && { return std::move(animation_); }

private:
  void add_channel(std::size_t node, const char* path, std::size_t samples) {
    animation_["channels"].push_back(
        {{"sampler", animation_["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation_["samplers"].push_back(
        {{"input", times_}, {"output", samples}, {"interpolation", "LINEAR"}});
  }

  GlbContainer& container_;
  const ShapeMotion& motion_;
  std::size_t times_ = 0;
  std::map<std::string, Eigen::Index, std::less<>> column_;
  Json animation_;
};

// A node above all others of the file's scene: its index.
std::size_t add_head_node(Json& json) {
  const std::size_t node = json["nodes"].size();
  Json& roots = json["scenes"].at(json.value("scene", std::size_t{0}))["nodes"];
  Json children = std::move(roots);
  json["nodes"].push_back({{"name", "head"}, {"children", std::move(children)}});
  json["scenes"].at(json.value("scene", std::size_t{0}))["nodes"] = Json::array({node});
  return node;
}

void animate(GlbContainer& container, const ShapeMotion& motion, const GlbNotes& notes) {
  Json& json = container.json;
  note(json, notes);
  Animation animation(container, motion);
  const std::size_t node_count = json["nodes"].size();
  for (std::size_t node = 0; node < node_count; ++node) {
    if (!json["nodes"][node].contains("mesh")) {
      continue;
    }
    const auto index = json["nodes"][node]["mesh"].get<std::size_t>();
    Json& mesh = json["meshes"].at(index);
    const std::size_t count = mesh["primitives"][0].value("targets", Json::array()).size();
    if (count > 0) {
      const std::vector<std::string> names = target_names(mesh, index, count);
      mesh["extras"]["targetNames"] = names;
      animation.move_shapes(node, names);
    }
  }
  if (!motion.head.empty()) {
    animation.move_head(add_head_node(json));
  }
  json["animations"] = Json::array({std::move(animation).json()});
}

} // namespace

std::string animated_glb(std::string_view glb, std::string_view where, const ShapeMotion& motion,
                         const GlbNotes& notes) {
  const Eigen::Index frames = motion.weights.frames.rows();
  if (frames == 0 ||
      motion.weights.frames.cols() != static_cast<Eigen::Index>(motion.weights.groups.size()) ||
      (!motion.head.empty() && static_cast<Eigen::Index>(motion.head.size()) != frames)) {
    throw InternalError({.what = "weights and head do not fit each other"});
  }
  GlbContainer container = parse_glb_container(glb, where);
  try {
    animate(container, motion, notes);
  } catch (const nlohmann::json::exception& defect) {
    throw InputError({.where = std::string(where),
                      .what = "this binary glTF file is damaged",
                      .got = defect.what()});
  }
  return container.bytes();
}

} // namespace phonomime
