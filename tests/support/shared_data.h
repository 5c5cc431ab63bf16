// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace phonomime::test {

// The folder of recordings to test against: $PHONOMIME_SHARED_DATA, else ../shared/data beside the
// repository. Nothing where neither exists.
inline std::optional<std::filesystem::path> shared_data() {
  const char* named = std::getenv("PHONOMIME_SHARED_DATA");
  const std::filesystem::path folder =
      named != nullptr ? std::filesystem::path(named)
                       : std::filesystem::path(PHONOMIME_SOURCE_DIR) / ".." / "shared" / "data";
  if (std::filesystem::is_directory(folder)) {
    return std::filesystem::canonical(folder);
  }
  return std::nullopt;
}

} // namespace phonomime::test

// At the top of a test that needs recordings from outside the repository.
#define PHONOMIME_NEEDS_SHARED_DATA(folder)                                                        \
  const auto folder##_or_nothing = ::phonomime::test::shared_data();                               \
  if (!folder##_or_nothing) {                                                                      \
    GTEST_SKIP() << "skipped: needs the recordings in ../shared/data, which are not here";         \
  }                                                                                                \
  const std::filesystem::path folder = *folder##_or_nothing
