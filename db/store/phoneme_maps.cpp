// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/phoneme_maps.h"

#include "db/store/blobs.h"
#include "db/store/database_impl.h"
#include "db/store/store_error.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>
#include <span>

namespace phonomime {
namespace {

using store::Connection;
using store::throw_damaged;

constexpr const char* kRecord =
    "SELECT k.name, p.name, m.made_of, m.neighbours, m.keep_largest, m.largest_exact, "
    "m.landmark_count, m.seed, m.nodes, m.frames, m.components, m.landmarks, m.far_frames, "
    "m.isomap_residual_variance, m.pca_residual_variance, m.placed, m.kept, m.isomap, m.pca "
    "FROM phoneme_maps m JOIN speakers k ON k.id = m.speaker_id "
    "JOIN phonemes p ON p.id = m.phoneme_id ";

// Columns of kRecord: counts that an int has room for.
int int_at(const Connection& connection, const SQLite::Statement& row, int column) {
  const std::int64_t value = row.getColumn(column).getInt64();
  if (value < 0 || value > std::numeric_limits<std::int32_t>::max()) {
    throw_damaged(connection.where(), fmt::format("a map with a count of {}", value));
  }
  return static_cast<int>(value);
}

StoredMapRecord read_record(const Connection& connection, const SQLite::Statement& row) {
  const auto share_at = [&](int column) {
    const double share = row.getColumn(column).getDouble();
    if (!(share >= 0.0 && share <= 1.0)) {
      throw_damaged(connection.where(), "a map with a residual variance outside 0 to 1");
    }
    return share;
  };
  return {.speaker = row.getColumn(0).getString(),
          .phoneme = row.getColumn(1).getString(),
          .made_of = row.getColumn(2).getString(),
          .neighbours = int_at(connection, row, 3),
          .keep_largest = row.getColumn(4).getInt() != 0,
          .largest_exact = int_at(connection, row, 5),
          .landmark_count = int_at(connection, row, 6),
          .seed = std::bit_cast<std::uint64_t>(row.getColumn(7).getInt64()),
          .nodes = int_at(connection, row, 8),
          .frames = int_at(connection, row, 9),
          .components = int_at(connection, row, 10),
          .landmarks = int_at(connection, row, 11),
          .far_frames = int_at(connection, row, 12),
          .isomap_residual_variance = share_at(13),
          .pca_residual_variance = share_at(14),
          .placed = int_at(connection, row, 15)};
}

StoredMap::Places read_places(const Connection& connection, const SQLite::Column& column,
                              std::int64_t count) {
  store::check_count<double>(column, 2 * count, connection.where(), "a map");
  StoredMap::Places places(count, 2);
  store::copy_numbers(column, std::span(places.data(), static_cast<std::size_t>(places.size())),
                      connection.where(), "a map");
  if (!places.allFinite()) {
    throw_damaged(connection.where(), "a map with places that are no numbers");
  }
  return places;
}

std::vector<std::int32_t> read_kept(const Connection& connection, const SQLite::Column& column,
                                    const StoredMapRecord& record) {
  store::check_count<std::int32_t>(column, record.placed, connection.where(), "a map's frames");
  std::vector<std::int32_t> kept(static_cast<std::size_t>(record.placed));
  store::copy_numbers(column, std::span(kept), connection.where(), "a map's frames");
  const bool ascends =
      std::adjacent_find(kept.begin(), kept.end(), std::greater_equal<>()) == kept.end();
  if (!ascends || (!kept.empty() && (kept.front() < 0 || kept.back() >= record.frames))) {
    throw_damaged(connection.where(), "a map of frames that there are not");
  }
  return kept;
}

// Id of a speaker or phoneme.
std::int64_t find_name(const Connection& connection, const char* table, const std::string& name) {
  SQLite::Statement select(connection.database(),
                           fmt::format("SELECT id FROM {} WHERE name = ?", table));
  select.bind(1, name);
  if (!select.executeStep()) {
    throw InternalError(
        {.where = connection.where(),
         .what = fmt::format("a map for {}, who is not among its {}", name, table)});
  }
  return select.getColumn(0).getInt64();
}

void bind_places(SQLite::Statement& statement, int index, const StoredMap::Places& places) {
  store::bind_numbers(statement, index,
                      std::span(places.data(), static_cast<std::size_t>(places.size())));
}

void check_parts(const Connection& connection, const StoredMap& map) {
  const auto placed = static_cast<Eigen::Index>(map.record.placed);
  if (map.isomap.rows() != placed || map.pca.rows() != placed ||
      map.kept.size() != static_cast<std::size_t>(placed) || !map.isomap.allFinite() ||
      !map.pca.allFinite()) {
    throw InternalError({.where = connection.where(), .what = "a map whose parts do not fit"});
  }
  if (!connection.writable()) {
    throw InternalError(
        {.where = connection.where(), .what = "a map for a database opened for reading"});
  }
}

} // namespace

std::vector<StoredMapRecord> MotionDatabase::list_maps(const std::string& speaker) const {
  const Connection& connection = *impl_->connection;
  return store::translated(connection.where(), [&] {
    SQLite::Statement select(connection.database(),
                             std::string(kRecord) + "WHERE k.name = ? ORDER BY p.name");
    select.bind(1, speaker);
    std::vector<StoredMapRecord> records;
    while (select.executeStep()) {
      records.push_back(read_record(connection, select));
    }
    return records;
  });
}

std::optional<StoredMap> MotionDatabase::load_map(const std::string& speaker,
                                                  const std::string& phoneme) const {
  const Connection& connection = *impl_->connection;
  return store::translated(connection.where(), [&]() -> std::optional<StoredMap> {
    SQLite::Statement select(connection.database(),
                             std::string(kRecord) + "WHERE k.name = ? AND p.name = ?");
    select.bind(1, speaker);
    select.bind(2, phoneme);
    if (!select.executeStep()) {
      return std::nullopt;
    }
    StoredMap map;
    map.record = read_record(connection, select);
    map.kept = read_kept(connection, select.getColumn(16), map.record);
    map.isomap = read_places(connection, select.getColumn(17), map.record.placed);
    map.pca = read_places(connection, select.getColumn(18), map.record.placed);
    return map;
  });
}

void MotionDatabase::save_map(const StoredMap& map) {
  const Connection& connection = *impl_->connection;
  check_parts(connection, map);
  const StoredMapRecord& record = map.record;
  store::translated(connection.where(), [&] {
    SQLite::Transaction transaction(connection.database(), SQLite::TransactionBehavior::IMMEDIATE);
    SQLite::Statement insert(
        connection.database(),
        "INSERT OR REPLACE INTO phoneme_maps (speaker_id, phoneme_id, made_of, neighbours, "
        "keep_largest, largest_exact, landmark_count, seed, nodes, frames, components, landmarks, "
        "far_frames, isomap_residual_variance, pca_residual_variance, placed, kept, isomap, pca) "
        "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    int at = 0;
    insert.bind(++at, find_name(connection, "speakers", record.speaker));
    insert.bind(++at, find_name(connection, "phonemes", record.phoneme));
    insert.bind(++at, record.made_of);
    insert.bind(++at, record.neighbours);
    insert.bind(++at, record.keep_largest ? 1 : 0);
    insert.bind(++at, record.largest_exact);
    insert.bind(++at, record.landmark_count);
    insert.bind(++at, std::bit_cast<std::int64_t>(record.seed));
    for (const std::int64_t count :
         {record.nodes, record.frames, record.components, record.landmarks, record.far_frames}) {
      insert.bind(++at, count);
    }
    insert.bind(++at, record.isomap_residual_variance);
    insert.bind(++at, record.pca_residual_variance);
    insert.bind(++at, record.placed);
    store::bind_numbers(insert, ++at, std::span(map.kept));
    bind_places(insert, ++at, map.isomap);
    bind_places(insert, ++at, map.pca);
    insert.exec();
    transaction.commit();
  });
}

} // namespace phonomime
