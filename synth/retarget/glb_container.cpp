// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/glb_container.h"

#include "db/types/errors.h"

#include <bit>
#include <cstdint>
#include <cstring>

namespace phonomime {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr int kFloat = 5126;
constexpr std::size_t kHeader = 12;
constexpr std::size_t kChunkHeader = 8;
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

void append_word(std::string& bytes, std::size_t word) {
  const auto value = static_cast<std::uint32_t>(word);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

[[noreturn]] void fail(std::string_view where, const char* what, const char* remedy = "") {
  throw InputError(
      {.where = std::string(where), .what = what, .expected = "binary glTF 2.0", .remedy = remedy});
}

// The lists that things are added to; what is in them are objects.
void complete_lists(Json& json, std::string_view where) {
  for (const char* name : {"buffers", "bufferViews", "accessors"}) {
    json.emplace(name, Json::array());
  }
  for (const char* name :
       {"nodes", "scenes", "meshes", "buffers", "bufferViews", "accessors", "animations"}) {
    const auto list = json.find(name);
    if (list == json.end()) {
      continue;
    }
    if (!list->is_array()) {
      fail(where, "this binary glTF file is damaged");
    }
    for (const Json& item : *list) {
      if (!item.is_object()) {
        fail(where, "this binary glTF file is damaged");
      }
    }
  }
}

} // namespace

std::size_t GlbContainer::add(const std::vector<float>& numbers, const char* type,
                              std::size_t width) {
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const std::size_t bytes = numbers.size() * sizeof(float);
  json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes}});
  binary.append(reinterpret_cast<const char*>(numbers.data()), bytes);
  json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                               {"componentType", kFloat},
                               {"count", numbers.size() / width},
                               {"type", type}});
  return json["accessors"].size() - 1;
}

std::size_t GlbContainer::add_times(std::size_t frames, double rate_hz) {
  std::vector<float> times;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    times.push_back(static_cast<float>(static_cast<double>(frame) / rate_hz));
  }
  const std::size_t accessor = add(times, "SCALAR", 1);
  json["accessors"][accessor]["min"] = {times.front()};
  json["accessors"][accessor]["max"] = {times.back()};
  return accessor;
}

std::string GlbContainer::bytes() {
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  json["buffers"][0]["byteLength"] = binary.size();
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string glb = "glTF";
  append_word(glb, kVersion);
  append_word(glb, kHeader + 2 * kChunkHeader + text.size() + binary.size());
  append_word(glb, text.size());
  append_word(glb, kJsonChunk);
  glb += text;
  append_word(glb, binary.size());
  append_word(glb, kBinaryChunk);
  return glb + binary;
}

GlbContainer parse_glb_container(std::string_view bytes, std::string_view where) {
  if (bytes.size() < kHeader + kChunkHeader || !bytes.starts_with("glTF") ||
      word_at(bytes, 4) != kVersion || word_at(bytes, kHeader + 4) != kJsonChunk) {
    fail(where, "this is not a binary glTF file");
  }
  GlbContainer container;
  bool has_data = false;
  for (std::size_t at = kHeader; at + kChunkHeader <= bytes.size();) {
    const std::size_t size = word_at(bytes, at);
    const std::uint32_t kind = word_at(bytes, at + 4);
    if (size > bytes.size() - at - kChunkHeader) {
      fail(where, "this binary glTF file is cut short");
    }
    const std::string_view chunk = bytes.substr(at + kChunkHeader, size);
    if (at == kHeader) {
      container.json = Json::parse(chunk, nullptr, false);
    } else if (kind == kBinaryChunk && !has_data) {
      container.binary = chunk;
      has_data = true;
    }
    at += kChunkHeader + size;
  }
  if (!container.json.is_object()) {
    fail(where, "this binary glTF file is damaged");
  }
  complete_lists(container.json, where);
  Json& buffers = container.json["buffers"];
  if (buffers.empty()) {
    buffers.push_back(Json::object());
  } else if (buffers[0].contains("uri")) {
    fail(where, "the data of this file are in another", "Export it as a single .glb.");
  } else if (!has_data) {
    fail(where, "this binary glTF file is damaged");
  }
  return container;
}

} // namespace phonomime
