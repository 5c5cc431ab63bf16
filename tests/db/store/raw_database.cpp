// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/db/store/raw_database.h"

#include "db/types/file_io.h"
#include "tests/support/temporary_folder.h"

#include <sqlite3.h>

#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

namespace fs = std::filesystem;

int add_row(void* rows, int count, char** values, char** /*names*/) {
  std::string joined;
  for (int i = 0; i < count; ++i) {
    joined += (i == 0 ? "" : "|") + std::string(values[i] == nullptr ? "NULL" : values[i]);
  }
  static_cast<std::vector<std::string>*>(rows)->push_back(joined);
  return 0;
}

} // namespace

std::vector<std::string> raw_query(const fs::path& path, const std::string& sql) {
  sqlite3* database = nullptr;
  std::vector<std::string> rows;
  char* message = nullptr;
  const bool done =
      sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READWRITE, nullptr) == SQLITE_OK &&
      sqlite3_exec(database, sql.c_str(), add_row, &rows, &message) == SQLITE_OK;
  EXPECT_TRUE(done) << path << ": " << sql << ": " << sqlite3_errmsg(database);
  sqlite3_free(message);
  sqlite3_close(database);
  return rows;
}

std::vector<std::string> raw_dump(const fs::path& path) {
  std::vector<std::string> dump =
      raw_query(path, "SELECT name, sql FROM sqlite_schema ORDER BY rowid");
  for (const std::string& table :
       raw_query(path, "SELECT name FROM sqlite_schema WHERE type = 'table' ORDER BY rowid")) {
    std::string fields;
    for (const std::string& column :
         raw_query(path, "SELECT name FROM pragma_table_info('" + table + "')")) {
      fields += (fields.empty() ? "quote(" : ", quote(") + column + ")";
    }
    for (const std::string& row : raw_query(path, "SELECT " + fields + " FROM " + table)) {
      dump.push_back(table + ": " + row);
    }
  }
  return dump;
}

void expect_sound(const fs::path& path) {
  EXPECT_EQ(raw_query(path, "PRAGMA integrity_check"), std::vector<std::string>{"ok"});
  EXPECT_EQ(raw_query(path, "PRAGMA foreign_key_check"), std::vector<std::string>{});
}

void expect_alone_and_whole(const fs::path& path) {
  const std::string bytes = read_file(path);
  ASSERT_GT(bytes.size(), 100u);
  // File format: 18 and 19 hold the write and read version, 1 = rollback journal, 2 = WAL.
  EXPECT_EQ(bytes[18], 1);
  EXPECT_EQ(bytes[19], 1);
  EXPECT_FALSE(fs::exists(path.string() + "-wal"));
  EXPECT_FALSE(fs::exists(path.string() + "-shm"));
  const TemporaryFolder elsewhere;
  fs::copy_file(path, elsewhere / "copy.db");
  EXPECT_TRUE(raw_dump(elsewhere / "copy.db") == raw_dump(path));
}

} // namespace phonomime::test
