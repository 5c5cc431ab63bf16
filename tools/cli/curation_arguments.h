// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/curate.h"
#include "tools/app/suspects.h"

#include <filesystem>

namespace phonomime {

// How a list of suspects is printed, unless as JSON.
enum class SuspectsForm { text, csv, keys };

struct SuspectsArguments {
  SuspectsOptions options;
  SuspectsForm form = SuspectsForm::text;
};

// prune, restore, undo
struct CurateArguments {
  CurateOptions options;
};

struct JournalArguments {
  std::filesystem::path database;
};

} // namespace phonomime
