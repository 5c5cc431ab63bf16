// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/option_checks.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <map>
#include <system_error>

#include <fmt/format.h>

namespace phonomime {

void check_range(const char* option, double value, double least, double most) {
  if (!(value >= least && value <= most)) {
    throw UsageError(
        {.where = option,
         .what = "is out of range",
         .expected = fmt::format("{} to {}", format_number(least), format_number(most)),
         .got = format_number(value)});
  }
}

void check_outputs_differ(const std::vector<std::filesystem::path>& outputs) {
  std::map<std::filesystem::path, std::filesystem::path> named; // by its one spelling
  for (const std::filesystem::path& path : outputs) {
    std::error_code error;
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    const auto place = std::filesystem::weakly_canonical(folder, error) / path.filename();
    const auto [first, is_new] = named.emplace(error ? path : place, path);
    if (!is_new) {
      throw UsageError({.where = path.string(),
                        .what = first->second == path ? "the output is named twice"
                                                      : "the output is named twice, as " +
                                                            quoted(first->second.string()) + " too",
                        .remedy = "Name each output once."});
    }
  }
}

void check_motion_options(const SynthOptions& options) {
  check_range("--smoothing", options.smoothing_half_window, 0, 100);
  check_range("--threads", options.threads, 0, 256);
  check_range("--blend", options.blend.value_or(kUsualBlend), 1, 100);
}

} // namespace phonomime
