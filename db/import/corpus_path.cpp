// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/corpus_path.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <string>
#include <system_error>

#include <fmt/format.h>

namespace phonomime {

namespace fs = std::filesystem;

fs::path path_in_corpus(const fs::path& folder, std::string_view named, std::string_view where) {
  const auto refuse = [&](std::string_view what, std::string remedy) {
    throw InputError({.where = std::string(where),
                      .what = fmt::format("path {} {}", quoted(named), what),
                      .expected = "the path of a file inside the corpus folder",
                      .remedy = std::move(remedy)});
  };
  const fs::path relative(named);
  if (relative.is_absolute()) {
    refuse("is absolute", "Copy the file into the corpus folder and name it relative to that.");
  }
  if (std::find(relative.begin(), relative.end(), "..") != relative.end()) {
    refuse("holds \"..\"", "Copy the file into the corpus folder.");
  }
  std::error_code error;
  const fs::path real = fs::canonical(folder / relative, error);
  if (error) {
    throw IoError({.where = std::string(where),
                   .what = fmt::format("file {} cannot be opened", quoted(named)),
                   .got = error.message()});
  }
  const auto [outside, ignored] =
      std::mismatch(folder.begin(), folder.end(), real.begin(), real.end());
  if (outside != folder.end()) {
    refuse("leads out of the corpus folder by a link", "Copy the file into the corpus folder.");
  }
  if (!fs::is_regular_file(real, error)) {
    refuse("is not a file", "");
  }
  return real;
}

} // namespace phonomime
