// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <SQLiteCpp/Database.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime::store {

// In every database's header ("PHMM"), so that another program's file is told from ours.
inline constexpr std::int32_t kApplicationId = 0x50484D4D;

// The step from schema version `version` - 1 to `version`; version 1 makes a new database.
struct Migration {
  int version = 0;
  std::string_view sql;
};

// corpora_schema/migrations in order, numbered from 1 without a hole.
std::vector<Migration> built_in_migrations();

// What a file's header says. Reads, never writes.
struct SchemaIdentity {
  std::int32_t application_id = 0;
  int version = 0;
};
SchemaIdentity read_identity(SQLite::Database& database);

// Throws InputError for a database of another program or of a version after the last migration.
void check_identity(const SchemaIdentity& identity, std::span<const Migration> migrations,
                    const std::string& where);

// Brings a database (also an empty file) to the last version in one transaction. Foreign keys must
// be off. True where it made a new database. Throws InputError as check_identity, and
// SQLite::Exception.
bool migrate(SQLite::Database& database, std::span<const Migration> migrations,
             const std::string& where);

} // namespace phonomime::store
