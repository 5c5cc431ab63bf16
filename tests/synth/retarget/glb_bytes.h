// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace phonomime::test {

template <typename T>
void append_bytes(std::string& to, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  to.append(bytes, sizeof value);
}

// A GLB container around a JSON text and its binary chunk, as the specification lays it out.
inline std::string glb_container(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string glb = "glTF";
  append_bytes<std::uint32_t>(glb, 2);
  append_bytes<std::uint32_t>(glb, static_cast<std::uint32_t>(28 + json.size() + binary.size()));
  append_bytes<std::uint32_t>(glb, static_cast<std::uint32_t>(json.size()));
  glb += "JSON" + json;
  append_bytes<std::uint32_t>(glb, static_cast<std::uint32_t>(binary.size()));
  glb += std::string("BIN\0", 4) + binary;
  return glb;
}

// A GLB of two nodes: a triangle (0 0 0, 1 0 0, 0 1 0) with 16-bit indices and a material under a
// node moved by (10, 0, 0) and scaled by 2, and the same positions without indices in a child
// turned by a quarter about z.
struct SmallGlb {
  nlohmann::json json;
  std::string binary;

  SmallGlb() {
    for (const float value : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) {
      append_bytes(binary, value);
    }
    for (const std::uint16_t index : std::initializer_list<std::uint16_t>{0, 1, 2}) {
      append_bytes(binary, index);
    }
    binary.resize(44);
    json = nlohmann::json::parse(R"({
      "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0, "translation": [10, 0, 0], "scale": [2, 2, 2], "children": [1]},
                {"mesh": 1, "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]},
                 {"primitives": [{"attributes": {"POSITION": 0}}]}],
      "materials": [{"name": "pink", "doubleSided": true,
                     "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1],
                                              "metallicFactor": 0, "roughnessFactor": 0.75}}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                     "min": [0, 0, 0], "max": [1, 1, 0]},
                    {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
      "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                      {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
      "buffers": [{"byteLength": 44}]})");
  }

  std::string bytes() const { return glb_container(json.dump(), binary); }
};

} // namespace phonomime::test
