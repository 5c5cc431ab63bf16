// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/store_error.h"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <sqlite3.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>

namespace phonomime::store {

static_assert(std::endian::native == std::endian::little,
              "blobs are little-endian and are copied as they are");

// Binds numbers as a blob without copying them: they must outlive the statement's execution.
template <typename Number>
void bind_numbers(SQLite::Statement& statement, int index, std::span<Number> numbers) {
  if (numbers.size_bytes() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw SQLite::Exception("blob too big", SQLITE_TOOBIG);
  }
  // An empty span may have no address, which SQLite would store as NULL.
  statement.bindNoCopy(index, numbers.empty() ? "" : static_cast<const void*>(numbers.data()),
                       static_cast<int>(numbers.size_bytes()));
}

// Throws InputError (damaged) where a blob does not hold exactly `count` numbers: to be asked
// before memory for them is, for the count comes from the file as well.
template <typename Number>
void check_count(const SQLite::Column& column, std::int64_t count, const std::string& where,
                 const char* what) {
  if (count < 0 || column.getBytes() / static_cast<std::int64_t>(sizeof(Number)) != count ||
      column.getBytes() % static_cast<int>(sizeof(Number)) != 0) {
    throw_damaged(where, std::string(what) + " has the wrong length");
  }
}

// Copies a blob of exactly as many numbers as `target` holds. Throws InputError (damaged).
template <typename Number>
void copy_numbers(const SQLite::Column& column, std::span<Number> target, const std::string& where,
                  const char* what) {
  check_count<Number>(column, static_cast<std::int64_t>(target.size()), where, what);
  if (!target.empty()) {
    std::memcpy(target.data(), column.getBlob(), target.size_bytes());
  }
}

} // namespace phonomime::store
