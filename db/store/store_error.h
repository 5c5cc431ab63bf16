// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/errors.h"

#include <SQLiteCpp/Exception.h>

#include <string>
#include <utility>

namespace phonomime::store {

// Throws the IoError, InputError or InternalError that stands for a failure of SQLite; `where` is
// the database's path.
[[noreturn]] void throw_translated(const SQLite::Exception& failure, const std::string& where);

// The content of a database is not what its schema promises. `what` says which part.
[[noreturn]] void throw_damaged(const std::string& where, const std::string& what);

// Calls `work`; failures of SQLite leave it as phonomime errors.
template <typename Work>
decltype(auto) translated(const std::string& where, Work&& work) {
  try {
    return std::forward<Work>(work)();
  } catch (const SQLite::Exception& failure) {
    throw_translated(failure, where);
  }
}

} // namespace phonomime::store
