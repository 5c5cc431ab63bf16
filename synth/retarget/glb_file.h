// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tinygltf {
struct Accessor;
class Model;
} // namespace tinygltf

namespace phonomime {

// A binary glTF 2.0 file whose every reference is looked up with care. Pictures are not decoded;
// files that need extensions are refused. All members throw InputError.
class GlbFile {
public:
  static constexpr std::size_t kMostElements = 20'000'000;

  // `where` names the bytes in errors.
  GlbFile(std::string_view bytes, std::string_view where);
  ~GlbFile();

  const std::string& where() const { return where_; }
  const tinygltf::Model& model() const { return *model_; }

  [[noreturn]] void fail(std::string what, std::string expected = {}, std::string got = {}) const;

  [[noreturn]] void fail_index(std::string_view kind, long long index, std::size_t count) const;

  template <typename T>
  const T& at(const std::vector<T>& items, int index, std::string_view kind) const {
    if (index < 0 || static_cast<std::size_t>(index) >= items.size()) {
      fail_index(kind, index, items.size());
    }
    return items[static_cast<std::size_t>(index)];
  }

  // First byte of each element and the distance between elements, all checked to lie inside.
  struct Elements {
    const unsigned char* first = nullptr;
    std::size_t stride = 0;
    std::size_t count = 0;
    int component = 0; // TINYGLTF_COMPONENT_TYPE_*
  };

  // Of an accessor of a TINYGLTF_TYPE_*, not stored sparsely. `what` names them in errors.
  Elements elements(int accessor_index, int type, std::string_view what) const;

  // Vectors of floats, three numbers each, that may be stored sparsely: those named replace zeros,
  // or what is stored whole.
  std::vector<float> vectors(int accessor_index, const std::string& what) const;

  // An element of unsigned integers of any size.
  std::size_t index_at(const Elements& source, std::size_t i) const;

private:
  Elements elements(const tinygltf::Accessor& accessor, int type, std::string_view what) const;
  void lay_over(const tinygltf::Accessor& accessor, const std::string& what,
                std::vector<float>& values) const;

  std::string where_;
  std::unique_ptr<tinygltf::Model> model_;
};

} // namespace phonomime
