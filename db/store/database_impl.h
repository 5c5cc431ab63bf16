// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/connection.h"
#include "db/store/motion_database.h"

#include <memory>

namespace phonomime {

// Shared with a running import, so that the order in which the two are destroyed does not matter.
struct MotionDatabase::Impl {
  std::shared_ptr<store::Connection> connection;
};

} // namespace phonomime
