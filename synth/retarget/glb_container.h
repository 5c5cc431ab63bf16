// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace phonomime {

// A binary glTF 2.0 file as its JSON and its data: what is added is appended, all else stays as it
// is. (GlbFile reads the numbers of a file.)
struct GlbContainer {
  nlohmann::ordered_json json; // "buffers", "bufferViews" and "accessors" are lists, one buffer
  std::string binary;          // of the first buffer

  // The accessor's index of numbers of which so many are one element of `type` ("SCALAR", "VEC4").
  std::size_t add(const std::vector<float>& numbers, const char* type, std::size_t width);
  // The same of the times of frames, at least one: k / rate.
  std::size_t add_times(std::size_t frames, double rate_hz);

  // The file. Pads the data.
  std::string bytes();
};

// `where` names the bytes in errors. Throws InputError: no binary glTF 2.0, cut short, JSON that
// cannot be read, lists that are none, data in another file.
GlbContainer parse_glb_container(std::string_view bytes, std::string_view where);

} // namespace phonomime
