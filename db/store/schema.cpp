// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/schema.h"

#include "corpora_schema/embedded.h"
#include "db/types/errors.h"
#include "db/types/text.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

namespace phonomime::store {

std::vector<Migration> built_in_migrations() {
  constexpr std::string_view folder = "migrations/";
  std::vector<Migration> migrations;
  for (const std::string_view path : corpora_schema::embedded_files(folder)) {
    const auto number = parse_integer(path.substr(folder.size(), 4));
    const int version = static_cast<int>(migrations.size()) + 1;
    if (!number || *number != version) {
      throw InternalError({.where = std::string(path),
                           .what = "migrations are not numbered one by one",
                           .expected = fmt::format("{:04}", version)});
    }
    migrations.push_back({version, corpora_schema::embedded_file(path)});
  }
  return migrations;
}

SchemaIdentity read_identity(SQLite::Database& database) {
  return {database.execAndGet("PRAGMA application_id").getInt(),
          database.execAndGet("PRAGMA user_version").getInt()};
}

void check_identity(const SchemaIdentity& identity, std::span<const Migration> migrations,
                    const std::string& where) {
  if (identity.application_id != kApplicationId) {
    throw InputError(
        {.where = where,
         .what = "this SQLite database belongs to another program",
         .expected = fmt::format("application_id {:#010x}", kApplicationId),
         .got = fmt::format("{:#010x}", static_cast<std::uint32_t>(identity.application_id)),
         .remedy = "Name a file made by `phonomime import`, or a new one."});
  }
  const int known = migrations.back().version;
  if (identity.version > known || identity.version < 1) {
    throw InputError({.where = where,
                      .what = "this program does not know the version of the database",
                      .expected = fmt::format("schema version 1 to {}", known),
                      .got = fmt::format("version {}", identity.version),
                      .remedy = "Use the version of Phonomime that made it, or a newer one."});
  }
}

bool migrate(SQLite::Database& database, std::span<const Migration> migrations,
             const std::string& where) {
  SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
  // Read again under the lock: another process may have migrated meanwhile.
  SchemaIdentity identity = read_identity(database);
  const bool is_new = identity.application_id == 0 && identity.version == 0 &&
                      database.execAndGet("SELECT count(*) FROM sqlite_schema").getInt() == 0;
  if (!is_new) {
    check_identity(identity, migrations, where);
  } else {
    database.exec(fmt::format("PRAGMA application_id = {}", kApplicationId));
  }
  for (const Migration& migration : migrations) {
    if (migration.version > identity.version) {
      database.exec(std::string(migration.sql));
      database.exec(fmt::format("PRAGMA user_version = {}", migration.version));
    }
  }
  if (SQLite::Statement(database, "PRAGMA foreign_key_check").executeStep()) {
    throw InternalError({.where = where, .what = "a migration broke references between tables"});
  }
  transaction.commit();
  return is_new;
}

} // namespace phonomime::store
