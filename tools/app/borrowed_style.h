// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/style/style_model.h"

#include <filesystem>
#include <string>
#include <vector>

namespace phonomime {

// A style model as a synthesis uses it.
struct StyleInUse {
  StyleModel model;
  std::string speaker; // whose recordings taught it; another's: borrowed
};

// A fresh model that knows all of `emotions`: the speaker's own where it does, else the first of
// another speaker's (by name) that does; the PCA is the same for all. A model that is borrowed
// changes `table`'s face as it would its own; the contacts of the lips are those of `table`. Throws
// InputError where there is none, and says what to do.
StyleInUse find_style_model(const std::filesystem::path& database, const MotionTable& table,
                            const std::vector<std::string>& emotions);

// What the stored models of all speakers are made of, as hexadecimal digits; empty where there are
// none.
std::string style_models_fingerprint(const std::filesystem::path& database);

} // namespace phonomime
