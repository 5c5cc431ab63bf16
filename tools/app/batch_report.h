// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/batch.h"

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace phonomime {

// The summary of a batch, as `batch --json` prints it (docs/batch.md).
nlohmann::ordered_json batch_to_json(const BatchOptions& options, const BatchReport& report);

// The same in a line for people.
std::string batch_to_text(const BatchReport& report);

} // namespace phonomime
