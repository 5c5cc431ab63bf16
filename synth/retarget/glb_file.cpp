// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/glb_file.h"

#include "db/types/errors.h"

#include <cstdint>
#include <cstring>
#include <exception>
#include <limits>
#include <utility>

#include <fmt/format.h>
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace phonomime {
namespace {

// Pictures are not looked at, so none is decoded.
bool pass_over_image(tinygltf::Image*, const int, std::string*, std::string*, int, int,
                     const unsigned char*, int, void*) {
  return true;
}

} // namespace

GlbFile::GlbFile(std::string_view bytes, std::string_view where)
    : where_(where), model_(std::make_unique<tinygltf::Model>()) {
  if (bytes.size() < 20 || bytes.substr(0, 4) != "glTF" ||
      bytes.size() > std::numeric_limits<unsigned>::max()) {
    fail("this is not a binary glTF file", "the bytes `glTF` at its start");
  }
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(pass_over_image, nullptr);
  std::string error;
  std::string warning;
  bool loaded = false;
  try {
    loaded = loader.LoadBinaryFromMemory(model_.get(), &error, &warning,
                                         reinterpret_cast<const unsigned char*>(bytes.data()),
                                         static_cast<unsigned>(bytes.size()));
  } catch (const std::exception& defect) {
    error = defect.what();
  }
  if (!loaded) {
    while (!error.empty() && (error.back() == '\n' || error.back() == '.')) {
      error.pop_back();
    }
    fail("this binary glTF file is damaged", {}, error);
  }
  if (!model_->extensionsRequired.empty()) {
    fail("the file needs an extension of glTF that Phonomime does not read", "plain glTF 2.0",
         model_->extensionsRequired.front());
  }
}

GlbFile::~GlbFile() = default;

void GlbFile::fail(std::string what, std::string expected, std::string got) const {
  throw InputError({.where = where_,
                    .what = std::move(what),
                    .expected = std::move(expected),
                    .got = std::move(got)});
}

void GlbFile::fail_index(std::string_view kind, long long index, std::size_t count) const {
  fail("a reference to a " + std::string(kind) + " leads nowhere",
       "less than " + std::to_string(count), std::to_string(index));
}

GlbFile::Elements GlbFile::elements(int accessor_index, int type, std::string_view what) const {
  return elements(at(model_->accessors, accessor_index, "accessor"), type, what);
}

GlbFile::Elements GlbFile::elements(const tinygltf::Accessor& accessor, int type,
                                    std::string_view what) const {
  if (accessor.sparse.isSparse || accessor.bufferView < 0) {
    fail(std::string(what) + " are stored sparsely, which Phonomime does not read");
  }
  if (accessor.type != type) {
    fail(std::string(what) + " have another type than glTF asks for");
  }
  const tinygltf::BufferView& view = at(model_->bufferViews, accessor.bufferView, "buffer view");
  const tinygltf::Buffer& buffer = at(model_->buffers, view.buffer, "buffer");
  const int stride = accessor.ByteStride(view);
  if (stride <= 0 || accessor.count == 0 || accessor.count > kMostElements) {
    fail("the number or the layout of the " + std::string(what) + " is not usable",
         "1 to " + std::to_string(kMostElements), std::to_string(accessor.count));
  }
  const std::size_t size = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)) *
      tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
  const std::size_t bytes = buffer.data.size();
  const std::size_t span = static_cast<std::size_t>(stride) * (accessor.count - 1) + size;
  if (view.byteOffset > bytes || accessor.byteOffset > bytes - view.byteOffset ||
      span > bytes - view.byteOffset - accessor.byteOffset) {
    fail("the " + std::string(what) + " reach past the end of the file's data",
         "at most " + std::to_string(bytes) + " bytes");
  }
  return {buffer.data.data() + view.byteOffset + accessor.byteOffset,
          static_cast<std::size_t>(stride), accessor.count, accessor.componentType};
}

std::vector<float> GlbFile::vectors(int accessor_index, const std::string& what) const {
  const tinygltf::Accessor& accessor = at(model_->accessors, accessor_index, "accessor");
  if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT ||
      accessor.type != TINYGLTF_TYPE_VEC3 || accessor.count == 0 ||
      accessor.count > kMostElements) {
    fail("the " + what + " are not vectors of floats");
  }
  std::vector<float> values(3 * accessor.count, 0.0F);
  if (accessor.bufferView >= 0) {
    tinygltf::Accessor whole = accessor;
    whole.sparse.isSparse = false;
    const Elements source = elements(whole, TINYGLTF_TYPE_VEC3, what);
    for (std::size_t i = 0; i < source.count; ++i) {
      std::memcpy(&values[3 * i], source.first + i * source.stride, 3 * sizeof(float));
    }
  }
  if (accessor.sparse.isSparse) {
    lay_over(accessor, what, values);
  }
  return values;
}

void GlbFile::lay_over(const tinygltf::Accessor& accessor, const std::string& what,
                       std::vector<float>& values) const {
  const auto& sparse = accessor.sparse;
  if (sparse.count < 1 || static_cast<std::size_t>(sparse.count) > accessor.count) {
    fail("the number of sparse " + what + " is not usable", fmt::format("1 to {}", accessor.count),
         std::to_string(sparse.count));
  }
  tinygltf::Accessor places;
  places.bufferView = sparse.indices.bufferView;
  places.byteOffset = static_cast<std::size_t>(sparse.indices.byteOffset);
  places.componentType = sparse.indices.componentType;
  places.type = TINYGLTF_TYPE_SCALAR;
  places.count = static_cast<std::size_t>(sparse.count);
  tinygltf::Accessor news = places;
  news.bufferView = sparse.values.bufferView;
  news.byteOffset = static_cast<std::size_t>(sparse.values.byteOffset);
  news.componentType = accessor.componentType;
  news.type = accessor.type;
  const Elements indices = elements(places, TINYGLTF_TYPE_SCALAR, "indices of the " + what);
  const Elements vectors = elements(news, TINYGLTF_TYPE_VEC3, what);
  for (std::size_t i = 0; i < indices.count; ++i) {
    const std::size_t index = index_at(indices, i);
    if (index >= accessor.count) {
      fail_index("vertex", static_cast<long long>(index), accessor.count);
    }
    std::memcpy(&values[3 * index], vectors.first + i * vectors.stride, 3 * sizeof(float));
  }
}

std::size_t GlbFile::index_at(const Elements& source, std::size_t i) const {
  const unsigned char* from = source.first + i * source.stride;
  if (source.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) {
    return *from;
  }
  if (source.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
    std::uint16_t value = 0;
    std::memcpy(&value, from, sizeof value);
    return value;
  }
  if (source.component != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    fail("indices are not stored as unsigned integers");
  }
  std::uint32_t value = 0;
  std::memcpy(&value, from, sizeof value);
  return value;
}

} // namespace phonomime
