// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// The whole file (or pipe). Throws IoError where it cannot be read, InputError where it is larger
// than `largest_bytes` or is a folder.
std::string read_file(const std::filesystem::path& path, std::uintmax_t largest_bytes = 1u << 30);

// Files that appear together and whole, or not at all: each is written to a temporary file beside
// its target; commit() renames all of them, destruction without commit removes them.
class OutputFiles {
public:
  OutputFiles() = default;
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;
  ~OutputFiles();

  // Writes `bytes` beside `target` (synchronised to disk). Throws IoError; also where the target is
  // a folder or a device.
  void stage(const std::filesystem::path& target, std::string_view bytes);

  // Renames every staged file onto its target, in the order staged. Throws IoError.
  void commit();

private:
  struct Staged {
    std::filesystem::path temporary;
    std::filesystem::path target;
  };
  std::vector<Staged> staged_;
};

// One file, whole or not at all. Throws IoError.
void write_file(const std::filesystem::path& target, std::string_view bytes);

} // namespace phonomime
