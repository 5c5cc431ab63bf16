// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/store_error.h"

#include <fmt/format.h>
#include <sqlite3.h>

namespace phonomime::store {

void throw_damaged(const std::string& where, const std::string& what) {
  throw InputError({.where = where,
                    .what = fmt::format("the database is damaged: {}", what),
                    .remedy = "Restore it from a copy, or import its corpora into a new file."});
}

void throw_translated(const SQLite::Exception& failure, const std::string& where) {
  const std::string message = failure.what();
  switch (failure.getErrorCode() & 0xff) { // the primary code of an extended one
  case SQLITE_NOTADB:
    throw InputError({.where = where,
                      .what = "this file is not a motion database",
                      .expected = "a file made by `phonomime import`",
                      .got = "a file that is not SQLite's",
                      .remedy = "Check the path."});
  case SQLITE_CORRUPT:
  case SQLITE_ERROR: // a table or column that the schema promises is gone
  case SQLITE_MISMATCH:
    throw_damaged(where, message);
  case SQLITE_FULL:
    throw IoError({.where = where,
                   .what = "the disk is full",
                   .remedy = "Free some space and try again; the database is as it was."});
  case SQLITE_BUSY:
  case SQLITE_LOCKED:
    throw IoError({.where = where,
                   .what = "another program is writing to this database",
                   .remedy = "Wait until it is done, then try again."});
  case SQLITE_READONLY:
    if (failure.getExtendedErrorCode() == SQLITE_READONLY_DBMOVED) {
      throw IoError({.where = where,
                     .what = "another program has removed or replaced this database meanwhile",
                     .remedy = "Try again."});
    }
    throw IoError({.where = where,
                   .what = "the database cannot be written",
                   .got = message,
                   .remedy = "Check that the file and its folder may be written to."});
  case SQLITE_CANTOPEN:
  case SQLITE_PERM:
  case SQLITE_AUTH:
    throw IoError({.where = where,
                   .what = "the database cannot be opened",
                   .got = message,
                   .remedy = "Check the path and that the file and its folder are accessible."});
  case SQLITE_IOERR:
    throw IoError({.where = where,
                   .what = "the database cannot be read or written",
                   .got = message,
                   .remedy = "Check the disk, its free space and the limit on file sizes."});
  case SQLITE_NOMEM:
    throw IoError({.where = where, .what = "not enough memory for the database"});
  case SQLITE_TOOBIG:
    throw InputError({.where = where,
                      .what = "a sentence is too long to be stored",
                      .expected = "less than 1 GB of frames",
                      .remedy = "Cut it into shorter ones with `start` and `end`."});
  default:
    throw InternalError({.where = where, .what = fmt::format("SQLite: {}", message)});
  }
}

} // namespace phonomime::store
