// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/connection.h"

#include "db/store/store_error.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/resource.h>

#include <system_error>

namespace phonomime::store {
namespace {

namespace fs = std::filesystem;

// How long a lock is waited for: a reader's or a commit's, never a whole import's.
constexpr int kBusyTimeout_ms = 2000;

// page_size: frames are blobs of 30 kB (coefficients) to 300 kB (channels) a sentence; 32 kB pages
// keep their overflow chains short; the tables of short rows waste less than 1 MB by them.
constexpr const char* kNewFilePragmas = "PRAGMA page_size = 32768";

// trusted_schema, cell_size_check: a file may come from anywhere.
// synchronous=FULL: everything that COMMIT promises is on the disk when it returns. The checkpoint
// that follows would sync the WAL anyway, so an import pays nothing for it.
// cache_size: 16 MB for dirty pages before they spill into the WAL; a bound on memory. To be set
// when SQLite knows the file's page size: it counts pages of the size it knows.
// wal_autocheckpoint=0: one checkpoint, after COMMIT, whose outcome we look at.
constexpr const char* kReadPragmas =
    "PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; PRAGMA foreign_keys = ON";
constexpr const char* kWritePragmas =
    "PRAGMA synchronous = FULL; PRAGMA cache_size = -16384; PRAGMA wal_autocheckpoint = 0";

bool has_content(const fs::path& path) {
  std::error_code ignored;
  const auto size = fs::file_size(path, ignored);
  return !ignored && size > 0;
}

fs::path beside(const fs::path& path, const char* suffix) {
  fs::path neighbour = path;
  neighbour += suffix;
  return neighbour;
}

// "file:" URI of an absolute path; everything but unreserved characters is escaped.
std::string immutable_uri(const fs::path& path) {
  std::string uri = "file:";
  for (const char c : path.string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '/' || c == '-' || c == '_' || c == '.' || c == '~';
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri + "?immutable=1";
}

// Opens and reads the first page, so that a failure shows here.
std::unique_ptr<SQLite::Database> open_and_touch(const std::string& name, int flags) {
  auto database = std::make_unique<SQLite::Database>(name, flags, kBusyTimeout_ms);
  database->exec("SELECT count(*) FROM sqlite_schema");
  return database;
}

std::string journal_mode(SQLite::Database& database) {
  return database.execAndGet("PRAGMA journal_mode").getString();
}

} // namespace

Connection::Connection(fs::path path, std::string where) noexcept
    : path_(std::move(path)), where_(std::move(where)) {}

std::shared_ptr<Connection> Connection::open(const fs::path& path, OpenMode mode,
                                             std::span<const Migration> migrations) {
  const std::string where = path.string();
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  const bool exists = fs::exists(status);
  if (exists && !fs::is_regular_file(status)) {
    throw InputError({.where = where,
                      .what = "a motion database is a file",
                      .got = fs::is_directory(status) ? "a folder" : "something else",
                      .remedy = "Name a file made by `phonomime import`, or a new one."});
  }
  if (!exists && mode == OpenMode::read_only) {
    throw IoError({.where = where,
                   .what = "there is no such database",
                   .remedy = "Check the path, or make it with `phonomime import CORPUS --db DB`."});
  }
  const fs::path absolute = fs::absolute(path);
  if (!exists && !fs::is_directory(absolute.parent_path(), failure)) {
    throw IoError({.where = where,
                   .what = "the folder of the new database does not exist",
                   .remedy = "Make the folder first."});
  }
  const std::shared_ptr<Connection> connection(new Connection(absolute, where));
  connection->file_existed_ = exists;
  translated(where, [&] {
    if (mode == OpenMode::read_only) {
      connection->open_read_only(migrations);
    } else {
      connection->open_read_write(migrations);
    }
    connection->check_length();
    connection->database_->exec(kReadPragmas);
  });
  return connection;
}

void Connection::open_reader(const std::string& name, int flags) {
  database_ = open_and_touch(name, flags);
  opened_as_ = name;
  opened_with_ = flags;
}

void Connection::open_read_only(std::span<const Migration> migrations) {
  const auto require_content = [&] {
    if (!has_content(path_)) {
      throw InputError({.where = where_,
                        .what = "this file is empty: there is no corpus in it",
                        .remedy = "Fill it with `phonomime import CORPUS --db DB`."});
    }
  };
  const auto let_a_writer_in = [&](const char* what) {
    try {
      Connection writer(path_, where_);
      writer.file_existed_ = true;
      writer.open_read_write(migrations);
    } catch (const IoError& cause) {
      throw IoError({.where = where_,
                     .what = what,
                     .got = cause.what(),
                     .remedy = "Copy it, with the files beside it whose names start with its own, "
                               "to a folder that may be written to."});
    }
    require_content();
    open_reader(path_.string(), SQLite::OPEN_READONLY);
  };
  require_content();
  try {
    open_reader(path_.string(), SQLite::OPEN_READONLY);
  } catch (const SQLite::Exception& failure) {
    const int code = failure.getErrorCode() & 0xff;
    if (code != SQLITE_CANTOPEN && code != SQLITE_READONLY && code != SQLITE_IOERR) {
      throw;
    }
    if (has_content(beside(path_, "-journal"))) { // of a killed writer
      let_a_writer_in("an interrupted change must be undone first, which needs to write");
    } else if (has_content(beside(path_, "-wal"))) {
      throw IoError({.where = where_,
                     .what = "the last changes to this database are still in the -wal file beside "
                             "it, and reading them needs a folder that may be written to",
                     .remedy = "Copy both files to such a folder."});
    } else {
      // Read-only media, or a folder where no file may be made: nobody can be writing.
      open_reader(immutable_uri(path_), SQLite::OPEN_READONLY | SQLite::OPEN_URI);
    }
  }
  const SchemaIdentity identity = read_identity(*database_);
  check_identity(identity, migrations, where_);
  if (identity.version < migrations.back().version) {
    database_.reset();
    let_a_writer_in("this database is of an older version and must be converted, which needs to "
                    "write");
  }
}

void Connection::open_read_write(std::span<const Migration> migrations) {
  // Looks first: a database that is not ours must not even have its own journal rolled back.
  if (has_content(path_) && !has_content(beside(path_, "-journal"))) {
    const auto probe = open_and_touch(path_.string(), SQLite::OPEN_READONLY);
    check_identity(read_identity(*probe), migrations, where_);
  }
  database_ = std::make_unique<SQLite::Database>(
      path_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusyTimeout_ms);
  if (sqlite3_db_readonly(database_->getHandle(), "main") == 1) {
    throw IoError({.where = where_,
                   .what = "the database cannot be written: the file is read-only",
                   .remedy = "Change its permissions, or work on a copy."});
  }
  writable_ = true;
  try {
    if (!has_content(path_)) {
      database_->exec(kNewFilePragmas);
    }
    made_new_ = migrate(*database_, migrations, where_);
    database_->exec(kWritePragmas);
  } catch (...) {
    // A disk too full for the tables leaves the file that opening made, without a byte in it.
    database_.reset();
    std::error_code ignored;
    if (!file_existed_ && !has_content(path_)) {
      fs::remove(path_, ignored);
    }
    throw;
  }
}

void Connection::check_length() const {
  // SQLite itself misses the loss of less than a page. Beside a journal the length is in flux.
  std::error_code failure;
  const std::uintmax_t size = fs::file_size(path_, failure);
  const auto page_size =
      static_cast<std::uintmax_t>(database_->execAndGet("PRAGMA page_size").getInt64());
  if (!failure && size % page_size != 0 && !has_content(beside(path_, "-wal")) &&
      !has_content(beside(path_, "-journal"))) {
    throw_damaged(where_, "its end is cut off");
  }
}

// In rollback mode no file changes while a transaction reads it; in WAL mode it does.
std::unique_ptr<SQLite::Database> Connection::reader_beside() const {
  if (opened_as_.empty() || journal_mode(*database_) == "wal") {
    return nullptr;
  }
  try {
    auto reader =
        std::make_unique<SQLite::Database>(opened_as_, opened_with_ | SQLite::OPEN_NOMUTEX, 0);
    reader->exec(kReadPragmas);
    reader->exec("BEGIN; SELECT count(*) FROM sqlite_schema");
    int moved = 1; // another file has the name now
    sqlite3_file_control(database_->getHandle(), "main", SQLITE_FCNTL_HAS_MOVED, &moved);
    return moved == 0 ? std::move(reader) : nullptr;
  } catch (const SQLite::Exception&) {
    return nullptr;
  }
}

void Connection::begin_writing() {
  database_->exec("PRAGMA journal_mode = WAL");
  if (journal_mode(*database_) != "wal") {
    throw IoError({.where = where_,
                   .what = "the database cannot be switched to write-ahead logging",
                   .remedy = "Use a local disk: network folders often lack the shared memory it "
                             "needs."});
  }
}

void Connection::check_space_for_checkpoint() const {
  // What is still in memory goes to the WAL now, so that it is not counted as free below.
  const int flushed = sqlite3_db_cacheflush(database_->getHandle());
  if (flushed != SQLITE_OK && flushed != SQLITE_BUSY) {
    // The connection's own message is still that of the last statement.
    throw SQLite::Exception(sqlite3_errstr(flushed), flushed);
  }
  const auto number = [&](const char* pragma) {
    return static_cast<std::uintmax_t>(database_->execAndGet(pragma).getInt64());
  };
  constexpr std::uintmax_t commit_pages = 4; // that COMMIT itself still writes
  const std::uintmax_t page_size = number("PRAGMA page_size");
  const std::uintmax_t whole = number("PRAGMA page_count") * page_size;
  struct rlimit limit {};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      limit.rlim_cur < whole) {
    throw IoError({.where = where_,
                   .what = "the limit on file sizes is too low for the database",
                   .expected = fmt::format("at least {} bytes", whole),
                   .got = fmt::format("{}", limit.rlim_cur),
                   .remedy = "Raise it (`ulimit -f`) and try again; the database is as it was."});
  }
  const std::uintmax_t wanted = whole + commit_pages * page_size;
  std::error_code failure;
  const std::uintmax_t present = fs::file_size(path_, failure);
  const fs::space_info space = fs::space(path_, failure);
  if (!failure && wanted > present && space.available < wanted - present) {
    throw IoError({.where = where_,
                   .what = "the disk is full",
                   .expected = fmt::format("{} MB more", ((wanted - present) >> 20) + 1),
                   .got = fmt::format("{} MB free", space.available >> 20),
                   .remedy = "Free some space and try again; the database is as it was."});
  }
}

void Connection::checkpoint() noexcept {
  database_->tryExec("PRAGMA wal_checkpoint(TRUNCATE)");
}

void Connection::end_writing() noexcept {
  try {
    if (writable_ && database_ && journal_mode(*database_) == "wal") {
      database_->setBusyTimeout(0); // others may stay for hours
      // First the truncation: on a full disk it frees what the change of mode needs.
      database_->tryExec("PRAGMA wal_checkpoint(TRUNCATE)");
      database_->tryExec("PRAGMA journal_mode = DELETE");
      database_->setBusyTimeout(kBusyTimeout_ms);
    }
  } catch (const SQLite::Exception&) {
    // As documented: the WAL stays, and with it everything that was committed.
  }
}

void Connection::remove_if_still_new() noexcept {
  try {
    if (journal_mode(*database_) == "wal") {
      return; // others have it open
    }
    // The lock keeps other processes from beginning an import while the file goes.
    database_->setBusyTimeout(0);
    const SQLite::Transaction lock(*database_, SQLite::TransactionBehavior::EXCLUSIVE);
    if (database_->execAndGet("SELECT count(*) FROM corpora").getInt() == 0) {
      std::error_code ignored;
      if (file_existed_) {
        fs::resize_file(path_, 0, ignored);
      } else {
        fs::remove(path_, ignored);
      }
    }
  } catch (const SQLite::Exception&) {
    // Somebody else is at work in it: then it is no longer ours to remove.
  }
}

Snapshot::Snapshot(const Connection& connection) {
  if (sqlite3_get_autocommit(connection.database().getHandle()) != 0) {
    transaction_.emplace(connection.database());
  }
}

Connection::~Connection() {
  end_writing();
  if (database_ && made_new_) {
    remove_if_still_new();
  }
}

} // namespace phonomime::store
