// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/motion_database.h"
#include "db/store/schema.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Transaction.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace phonomime::store {

// An open database of the last schema version. At rest the file is in journal_mode=DELETE, alone
// and whole, so that it can be copied; between begin_writing and end_writing it is in WAL mode.
class Connection {
public:
  // As MotionDatabase::open; older versions are migrated (also for read_only, where the file may be
  // written). `migrations` are the built-in ones outside tests.
  static std::shared_ptr<Connection> open(const std::filesystem::path& path, OpenMode mode,
                                          std::span<const Migration> migrations);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  // Takes a new file away again where no corpus was committed to it.
  ~Connection();

  SQLite::Database& database() const { return *database_; }
  const std::string& where() const { return where_; }
  const std::filesystem::path& path() const { return path_; }
  bool writable() const { return writable_; }

  // A connection for one other thread that reads the same state, while this one is within a
  // transaction that has begun to read. Nothing where that cannot be promised at once: this one
  // writes, the database is in WAL mode, a writer waits for its readers to leave.
  std::unique_ptr<SQLite::Database> reader_beside() const;

  // WAL mode for an import. Throws SQLite::Exception (busy).
  void begin_writing();

  // Throws IoError where the disk has no room, or the limit on file sizes leaves none, to bring the
  // open transaction from the WAL into the file: asked before COMMIT, for afterwards it is too late
  // to say no.
  void check_space_for_checkpoint() const;

  // Brings what was committed from the WAL into the file, and goes back to journal_mode=DELETE.
  // Where that is impossible (another connection still reads, the disk has filled up) the WAL stays
  // beside the file: SQLite reads both, and the next writer tries again.
  void checkpoint() noexcept;
  void end_writing() noexcept;

private:
  Connection(std::filesystem::path path, std::string where) noexcept;
  void open_reader(const std::string& name, int flags);
  void open_read_only(std::span<const Migration> migrations);
  void open_read_write(std::span<const Migration> migrations);
  void check_length() const;
  void remove_if_still_new() noexcept;

  std::filesystem::path path_; // absolute
  std::string where_;          // as given, for messages
  std::unique_ptr<SQLite::Database> database_;
  std::string opened_as_; // what SQLite was asked to open, and how; empty where it writes
  int opened_with_ = 0;
  bool writable_ = false;
  bool made_new_ = false;     // this connection made the tables
  bool file_existed_ = false; // as an empty file, where made_new_
};

// One state of the database for all reads in a scope, whatever another process commits meanwhile.
// Within an import it is the import's own state.
class Snapshot {
public:
  explicit Snapshot(const Connection& connection);

private:
  std::optional<SQLite::Transaction> transaction_;
};

} // namespace phonomime::store
