// SPDX-License-Identifier: GPL-3.0-or-later
#include "corpora_schema/embedded.h"

#include <stdexcept>
#include <string>

namespace phonomime::corpora_schema {

struct EmbeddedFile {
  std::string_view path;
  std::string_view content;
};

// Made by embed.cmake, in alphabetical order of the paths.
extern const EmbeddedFile kEmbeddedFiles[];
extern const int kEmbeddedFileCount;

std::string_view embedded_file(std::string_view path) {
  for (int i = 0; i < kEmbeddedFileCount; ++i) {
    if (kEmbeddedFiles[i].path == path) {
      return kEmbeddedFiles[i].content;
    }
  }
  throw std::out_of_range("no embedded file " + std::string(path));
}

std::vector<std::string_view> embedded_files(std::string_view folder) {
  std::vector<std::string_view> paths;
  for (int i = 0; i < kEmbeddedFileCount; ++i) {
    if (kEmbeddedFiles[i].path.starts_with(folder)) {
      paths.push_back(kEmbeddedFiles[i].path);
    }
  }
  return paths;
}

} // namespace phonomime::corpora_schema
