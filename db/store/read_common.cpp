// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/read_common.h"

#include "db/store/blobs.h"
#include "db/store/store_error.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <cmath>

namespace phonomime::store {
namespace {

Visibility parse_visibility(const std::string& name, const std::string& where) {
  for (const Visibility visibility :
       {Visibility::high, Visibility::intermediate, Visibility::low}) {
    if (name == visibility_name(visibility)) {
      return visibility;
    }
  }
  throw_damaged(where, fmt::format("unknown visibility \"{}\"", name));
}

} // namespace

const char* visibility_name(Visibility visibility) {
  switch (visibility) {
  case Visibility::high:
    return "high";
  case Visibility::low:
    return "low";
  case Visibility::intermediate:
    break;
  }
  return "intermediate";
}

std::optional<Settings> read_settings(const Connection& connection) {
  SQLite::Statement statement(connection.database(), "SELECT rate_hz, layout_json FROM settings");
  if (!statement.executeStep()) {
    return std::nullopt;
  }
  Settings settings{statement.getColumn(0).getDouble(),
                    parse_layout(statement.getColumn(1).getString(), connection.where())};
  if (!std::isfinite(settings.rate_hz) || settings.rate_hz <= 0.0) {
    throw_damaged(connection.where(), "the frame rate is not positive");
  }
  return settings;
}

Settings require_settings(const Connection& connection) {
  std::optional<Settings> settings = read_settings(connection);
  if (!settings) {
    throw InputError({.where = connection.where(),
                      .what = "there is no corpus in this database yet",
                      .remedy = "Fill it with `phonomime import CORPUS --db DB`."});
  }
  return *std::move(settings);
}

Eigen::VectorXd read_vector(const Connection& connection, const SQLite::Column& column,
                            Eigen::Index count, const char* what) {
  check_count<double>(column, count, connection.where(), what);
  Eigen::VectorXd vector(count);
  copy_numbers(column, std::span(vector.data(), static_cast<std::size_t>(count)),
               connection.where(), what);
  if (!vector.allFinite()) {
    throw_damaged(connection.where(), fmt::format("{} holds something that is no number", what));
  }
  return vector;
}

FrameMatrix read_frames(const Connection& connection, const SQLite::Column& column,
                        Eigen::Index frames, Eigen::Index columns) {
  check_count<float>(column, frames * columns, connection.where(), "a sentence's block of frames");
  FrameMatrix matrix(frames, columns);
  copy_numbers(column, std::span(matrix.data(), static_cast<std::size_t>(matrix.size())),
               connection.where(), "a sentence's block of frames");
  if (!matrix.allFinite()) {
    throw_damaged(connection.where(), "frames that are no numbers");
  }
  return matrix;
}

std::optional<PcaModel> read_pca(const Connection& connection, int channel_count) {
  SQLite::Statement statement(connection.database(),
                              "SELECT dimensions, mean, basis, variance, total_variance FROM pca");
  if (!statement.executeStep()) {
    return std::nullopt;
  }
  const Eigen::Index dimensions = statement.getColumn(0).getInt();
  if (dimensions < 1 || dimensions > channel_count) {
    throw_damaged(connection.where(), fmt::format("a PCA of {} dimensions", dimensions));
  }
  PcaModel pca;
  pca.mean = read_vector(connection, statement.getColumn(1), channel_count, "the PCA's mean");
  pca.basis =
      read_vector(connection, statement.getColumn(2), dimensions * channel_count, "the PCA's basis")
          .reshaped(channel_count, dimensions);
  pca.variance = read_vector(connection, statement.getColumn(3), dimensions, "the PCA's variance");
  pca.total_variance = statement.getColumn(4).getDouble();
  return pca;
}

std::vector<StoredPhoneme> read_phonemes(const Connection& connection) {
  SQLite::Statement statement(
      connection.database(),
      "SELECT id, name, viseme, visibility FROM phonemes ORDER BY name <> ?, name");
  statement.bind(1, std::string(kSilence));
  std::vector<StoredPhoneme> phonemes;
  while (statement.executeStep()) {
    phonemes.push_back(
        {statement.getColumn(0).getInt64(),
         {statement.getColumn(1).getString(), statement.getColumn(2).getString(),
          parse_visibility(statement.getColumn(3).getString(), connection.where())}});
  }
  return phonemes;
}

std::vector<NamedRow> read_names(const Connection& connection, const char* table) {
  SQLite::Statement statement(connection.database(),
                              fmt::format("SELECT id, name FROM {} ORDER BY name", table));
  std::vector<NamedRow> rows;
  while (statement.executeStep()) {
    rows.push_back({statement.getColumn(0).getInt64(), statement.getColumn(1).getString()});
  }
  return rows;
}

std::vector<std::string> names_of(const std::vector<NamedRow>& rows) {
  std::vector<std::string> names;
  for (const NamedRow& row : rows) {
    names.push_back(row.name);
  }
  return names;
}

} // namespace phonomime::store
