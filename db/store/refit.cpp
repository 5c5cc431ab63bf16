// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/refit.h"

#include "db/store/blobs.h"
#include "db/store/projection.h"
#include "db/store/store_error.h"

#include <algorithm>

namespace phonomime::store {
namespace {

// Sentences that are in memory and projected at once, by several threads.
constexpr std::size_t kBatch = 16;

template <typename Matrix>
auto numbers(const Matrix& matrix) {
  return std::span(matrix.data(), static_cast<std::size_t>(matrix.size()));
}

void store_pca(const Connection& connection, const PcaModel& pca) {
  SQLite::Statement insert(connection.database(),
                           "INSERT OR REPLACE INTO pca (id, dimensions, mean, basis, variance, "
                           "total_variance) VALUES (1, ?, ?, ?, ?, ?)");
  insert.bind(1, static_cast<std::int64_t>(pca.dimension_count()));
  bind_numbers(insert, 2, numbers(pca.mean));
  bind_numbers(insert, 3, numbers(pca.basis)); // column-major: one dimension after the other
  bind_numbers(insert, 4, numbers(pca.variance));
  insert.bind(5, pca.total_variance);
  insert.exec();
}

void check_pca(const PcaModel& pca, const ImportState& import) {
  const Eigen::Index channels = import.layout.channel_count();
  const bool fits = pca.mean.size() == channels && pca.basis.rows() == channels &&
                    pca.basis.cols() >= 1 && pca.basis.cols() <= channels &&
                    pca.variance.size() == pca.basis.cols();
  if (!fits || !pca.mean.allFinite() || !pca.basis.allFinite() || !pca.variance.allFinite()) {
    throw InternalError({.where = import.connection->where(),
                         .what = "a PCA that does not fit the layout's channels"});
  }
}

} // namespace

ChannelReader::ChannelReader(const Connection& connection, int channel_count)
    : connection_(connection), channel_count_(channel_count),
      select_(connection.database(),
              "SELECT s.frame_count, c.frames, c.frame_has_gap FROM sentences s "
              "JOIN channels c ON c.sentence_id = s.id WHERE s.id = ?") {}

FrameMatrix ChannelReader::read(std::int64_t sentence_id) {
  select_.reset();
  select_.bind(1, sentence_id);
  if (!select_.executeStep()) {
    throw_damaged(connection_.where(), "a sentence without channels");
  }
  return read_frames(connection_, select_.getColumn(1), select_.getColumn(0).getInt(),
                     channel_count_);
}

std::vector<std::uint8_t> ChannelReader::frame_has_gap(Eigen::Index frames) const {
  std::vector<std::uint8_t> gaps(static_cast<std::size_t>(frames));
  copy_numbers(select_.getColumn(2), std::span(gaps), connection_.where(), "a sentence's gaps");
  return gaps;
}

void refit(const ImportState& import, const PcaModel& pca, const Progress& progress) {
  check_pca(pca, import);
  const Connection& connection = *import.connection;
  store_pca(connection, pca);
  ChannelReader reader(connection, import.layout.channel_count());
  SQLite::Statement insert(
      connection.database(),
      "INSERT OR REPLACE INTO coefficients (sentence_id, frames) VALUES (?, ?)");
  const Projection projection(pca);
  std::vector<Projection::Job> jobs(kBatch);
  const std::vector<std::int64_t> ids = import.sentence_ids();
  const auto total = static_cast<std::int64_t>(ids.size());
  for (std::size_t first = 0; first < ids.size(); first += kBatch) {
    progress.update("coefficients", static_cast<std::int64_t>(first), total);
    const std::size_t count = std::min(kBatch, ids.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      projection.prepare(jobs[i], reader.read(ids[first + i]));
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t i = 0; i < count; ++i) {
      projection.run(jobs[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      insert.reset();
      insert.bind(1, ids[first + i]);
      bind_numbers(insert, 2, numbers(jobs[i].coefficients));
      insert.exec();
    }
  }
  progress.update("coefficients", total, total);
}

} // namespace phonomime::store
