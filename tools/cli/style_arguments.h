// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/style_apply.h"
#include "tools/app/style_models.h"

#include <filesystem>
#include <string>

namespace phonomime {

// What the words of `phonomime style ...` ask for.
struct StyleTrainArguments {
  StyleTrainOptions options;
};

struct StyleShowArguments {
  std::filesystem::path database;
  std::string speaker;
};

struct StyleApplyArguments {
  StyleApplyOptions options;
};

} // namespace phonomime
