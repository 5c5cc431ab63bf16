// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace phonomime::store {

// The time of day, UTC, "2026-01-02T03:04:05Z"; $SOURCE_DATE_EPOCH instead of the clock where it is
// set (reproducible-builds.org), for those who want the same bytes.
std::string timestamp();

} // namespace phonomime::store
