// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/style_models.h"

#include "db/store/blobs.h"
#include "db/store/database_impl.h"
#include "db/store/store_error.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace phonomime {
namespace {

using store::Connection;
using store::throw_damaged;

// More than any model has, so that a damaged count asks for no memory.
constexpr std::int64_t kLargestSize = 1'000'000;

void check_parts(const Connection& connection, const StoredStyleModel& model) {
  const bool fits = std::ranges::all_of(model.matrices, [](const auto& entry) {
    return entry.second.size() > 0 && entry.second.allFinite();
  });
  if (!fits || model.matrices.empty()) {
    throw InternalError(
        {.where = connection.where(), .what = "a style model with a matrix that has no numbers"});
  }
  if (!connection.writable()) {
    throw InternalError(
        {.where = connection.where(), .what = "a style model for a database opened for reading"});
  }
}

// Columns `first` (rows), `first` + 1 (columns) and `first` + 2 (numbers).
Eigen::MatrixXd read_matrix(const Connection& connection, const SQLite::Statement& row, int first) {
  const std::int64_t rows = row.getColumn(first).getInt64();
  const std::int64_t columns = row.getColumn(first + 1).getInt64();
  if (rows < 1 || columns < 1 || rows > kLargestSize || columns > kLargestSize) {
    throw_damaged(connection.where(), "a style model's matrix has no size");
  }
  const SQLite::Column numbers = row.getColumn(first + 2);
  store::check_count<double>(numbers, rows * columns, connection.where(), "a style model's matrix");
  Eigen::MatrixXd matrix(rows, columns);
  store::copy_numbers(numbers, std::span(matrix.data(), static_cast<std::size_t>(matrix.size())),
                      connection.where(), "a style model's matrix");
  if (!matrix.allFinite()) {
    throw_damaged(connection.where(), "a style model's matrix has entries that are no numbers");
  }
  return matrix;
}

std::int64_t find_speaker(const Connection& connection, const std::string& name) {
  SQLite::Statement select(connection.database(), "SELECT id FROM speakers WHERE name = ?");
  select.bind(1, name);
  if (!select.executeStep()) {
    throw InternalError(
        {.where = connection.where(),
         .what = fmt::format("a style model of {}, who is not among its speakers", name)});
  }
  return select.getColumn(0).getInt64();
}

} // namespace

std::optional<StoredStyleModel> MotionDatabase::load_style_model(const std::string& speaker) const {
  const Connection& connection = *impl_->connection;
  return store::translated(connection.where(), [&]() -> std::optional<StoredStyleModel> {
    const store::Snapshot snapshot(connection);
    SQLite::Statement select(connection.database(),
                             "SELECT m.speaker_id, m.made_of, m.trained_json FROM style_models m "
                             "JOIN speakers k ON k.id = m.speaker_id WHERE k.name = ?");
    select.bind(1, speaker);
    if (!select.executeStep()) {
      return std::nullopt;
    }
    StoredStyleModel model{.speaker = speaker,
                           .made_of = select.getColumn(1).getString(),
                           .trained_json = select.getColumn(2).getString()};
    SQLite::Statement matrices(connection.database(),
                               "SELECT name, row_count, column_count, numbers FROM style_matrices "
                               "WHERE speaker_id = ? ORDER BY name");
    matrices.bind(1, select.getColumn(0).getInt64());
    while (matrices.executeStep()) {
      model.matrices.emplace(matrices.getColumn(0).getString(),
                             read_matrix(connection, matrices, 1));
    }
    return model;
  });
}

void MotionDatabase::save_style_model(const StoredStyleModel& model) {
  const Connection& connection = *impl_->connection;
  check_parts(connection, model);
  store::translated(connection.where(), [&] {
    SQLite::Transaction transaction(connection.database(), SQLite::TransactionBehavior::IMMEDIATE);
    const std::int64_t speaker = find_speaker(connection, model.speaker);
    for (const char* table : {"style_matrices", "style_models"}) {
      SQLite::Statement remove(connection.database(),
                               fmt::format("DELETE FROM {} WHERE speaker_id = ?", table));
      remove.bind(1, speaker);
      remove.exec();
    }
    SQLite::Statement insert(
        connection.database(),
        "INSERT INTO style_models (speaker_id, made_of, trained_json) VALUES (?, ?, ?)");
    insert.bind(1, speaker);
    insert.bind(2, model.made_of);
    insert.bind(3, model.trained_json);
    insert.exec();
    SQLite::Statement insert_matrix(connection.database(),
                                    "INSERT INTO style_matrices (speaker_id, name, row_count, "
                                    "column_count, numbers) VALUES (?, ?, ?, ?, ?)");
    for (const auto& [name, matrix] : model.matrices) {
      insert_matrix.reset();
      insert_matrix.bind(1, speaker);
      insert_matrix.bind(2, name);
      insert_matrix.bind(3, static_cast<std::int64_t>(matrix.rows()));
      insert_matrix.bind(4, static_cast<std::int64_t>(matrix.cols()));
      store::bind_numbers(insert_matrix, 5,
                          std::span(matrix.data(), static_cast<std::size_t>(matrix.size())));
      insert_matrix.exec();
    }
    transaction.commit();
  });
}

} // namespace phonomime
