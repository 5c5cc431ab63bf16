// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/temporary_folder.h"

#include "db/types/errors.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

namespace phonomime {

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const std::filesystem::path place = std::filesystem::temp_directory_path(error);
  std::string name = (place / "phonomime_XXXXXX").string();
  if (error || mkdtemp(name.data()) == nullptr) {
    throw IoError({.where = place.string(),
                   .what = "no folder for temporary files can be made",
                   .got = error ? error.message() : std::strerror(errno),
                   .remedy = "Name a folder that can be written to in $TMPDIR."});
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

} // namespace phonomime
