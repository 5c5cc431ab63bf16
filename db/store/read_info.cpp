// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/blobs.h"
#include "db/store/database_impl.h"
#include "db/store/read_common.h"
#include "db/store/store_error.h"
#include "db/types/text.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

namespace phonomime {
namespace {

using store::Connection;
using store::throw_damaged;

std::int64_t count(const Connection& connection, const char* query) {
  return connection.database().execAndGet(query).getInt64();
}

std::vector<DatabaseInfo::Count> counts(const Connection& connection, const char* query) {
  SQLite::Statement statement(connection.database(), query);
  std::vector<DatabaseInfo::Count> result;
  while (statement.executeStep()) {
    result.push_back({statement.getColumn(0).getString(), statement.getColumn(1).getInt64()});
  }
  return result;
}

std::vector<CorpusRecord> read_corpora(const Connection& connection) {
  SQLite::Statement statement(
      connection.database(),
      "SELECT name, phoneme_set, synthetic, imported_at, report_json, "
      "(SELECT count(*) FROM sentences WHERE corpus_id = corpora.id) FROM corpora ORDER BY id");
  std::vector<CorpusRecord> corpora;
  while (statement.executeStep()) {
    corpora.push_back({.name = statement.getColumn(0).getString(),
                       .phoneme_set = statement.getColumn(1).getString(),
                       .synthetic = statement.getColumn(2).getInt() != 0,
                       .imported_at = statement.getColumn(3).getString(),
                       .sentences = statement.getColumn(5).getInt64(),
                       .report_json = statement.getColumn(4).getString()});
  }
  return corpora;
}

// Id and frame count of a sentence.
struct FoundSentence {
  std::int64_t id = 0;
  Eigen::Index frame_count = 0;
};

FoundSentence find_sentence(const Connection& connection, const SentenceInfo& sentence) {
  SQLite::Statement statement(
      connection.database(),
      "SELECT s.id, s.frame_count FROM sentences s JOIN speakers k ON k.id = s.speaker_id "
      "JOIN emotions e ON e.id = s.emotion_id WHERE k.name = ? AND e.name = ? AND s.name = ?");
  statement.bind(1, sentence.speaker);
  statement.bind(2, sentence.emotion);
  statement.bind(3, sentence.id);
  if (!statement.executeStep()) {
    throw InputError({.where = connection.where(),
                      .what = fmt::format("there is no sentence {}/{}/{}", sentence.speaker,
                                          sentence.emotion, sentence.id)});
  }
  const std::int64_t frame_count = statement.getColumn(1).getInt64();
  // Before a matrix of that many rows is made: a blob holds 1e9 bytes at most.
  if (frame_count < 1 || frame_count > 1'000'000'000) {
    throw_damaged(connection.where(), fmt::format("a sentence of {} frames", frame_count));
  }
  return {statement.getColumn(0).getInt64(), static_cast<Eigen::Index>(frame_count)};
}

} // namespace

bool MotionDatabase::empty() const {
  const Connection& connection = *impl_->connection;
  return store::translated(connection.where(),
                           [&] { return count(connection, "SELECT count(*) FROM corpora") == 0; });
}

std::vector<std::string> MotionDatabase::speakers() const {
  const Connection& connection = *impl_->connection;
  return store::translated(connection.where(), [&] {
    return store::names_of(store::read_names(connection, "speakers"));
  });
}

DatabaseInfo MotionDatabase::info() const {
  const Connection& connection = *impl_->connection;
  return store::translated(connection.where(), [&] {
    const store::Snapshot snapshot(connection);
    DatabaseInfo info;
    info.path = connection.where();
    info.schema_version = store::read_identity(connection.database()).version;
    if (std::optional<store::Settings> settings = store::read_settings(connection)) {
      info.rate_hz = settings->rate_hz;
      info.layout = std::move(settings->layout);
      info.pca = store::read_pca(connection, info.layout.channel_count()).value_or(PcaModel());
    }
    info.corpora = read_corpora(connection);
    info.speakers = store::names_of(store::read_names(connection, "speakers"));
    info.emotions = store::names_of(store::read_names(connection, "emotions"));
    info.sentences = count(connection, "SELECT count(*) FROM sentences");
    info.frames = count(connection, "SELECT coalesce(sum(frame_count), 0) FROM sentences");
    info.nodes = count(connection, "SELECT count(*) FROM nodes");
    info.pruned = count(connection, "SELECT count(*) FROM prunings");
    info.suspect =
        count(connection, "SELECT count(*) FROM (SELECT DISTINCT sentence_id, row FROM suspects)");
    info.with_gaps = count(connection, "SELECT count(*) FROM nodes WHERE has_gap = 1");
    info.nodes_per_phoneme =
        counts(connection, "SELECT p.name, count(*) FROM nodes n JOIN phonemes p "
                           "ON p.id = n.phoneme_id GROUP BY p.name ORDER BY p.name");
    info.nodes_per_emotion =
        counts(connection, "SELECT e.name, count(*) FROM nodes n JOIN emotions e "
                           "ON e.id = n.emotion_id GROUP BY e.name ORDER BY e.name");
    info.triphones =
        count(connection, "SELECT count(*) FROM (SELECT DISTINCT previous_phoneme_id, phoneme_id, "
                          "next_phoneme_id FROM nodes)");
    return info;
  });
}

FrameMatrix MotionDatabase::load_channels(const SentenceInfo& sentence) const {
  const Connection& connection = *impl_->connection;
  return store::translated(connection.where(), [&] {
    const store::Snapshot snapshot(connection);
    const FoundSentence found = find_sentence(connection, sentence);
    SQLite::Statement statement(connection.database(),
                                "SELECT frames FROM channels WHERE sentence_id = ?");
    statement.bind(1, found.id);
    if (!statement.executeStep()) {
      throw_damaged(connection.where(), "a sentence without channels");
    }
    return store::read_frames(connection, statement.getColumn(0), found.frame_count,
                              store::require_settings(connection).layout.channel_count());
  });
}

std::vector<HeadPose> MotionDatabase::load_head(const SentenceInfo& sentence) const {
  const Connection& connection = *impl_->connection;
  return store::translated(connection.where(), [&] {
    const store::Snapshot snapshot(connection);
    const FoundSentence found = find_sentence(connection, sentence);
    SQLite::Statement statement(connection.database(),
                                "SELECT poses FROM head_poses WHERE sentence_id = ?");
    statement.bind(1, found.id);
    std::vector<HeadPose> poses;
    if (!statement.executeStep()) {
      return poses; // a layout of weights
    }
    const FrameMatrixD numbers =
        store::read_vector(connection, statement.getColumn(0), found.frame_count * 7,
                           "a sentence's head poses")
            .reshaped<Eigen::RowMajor>(found.frame_count, 7);
    for (Eigen::Index i = 0; i < found.frame_count; ++i) {
      HeadPose& pose = poses.emplace_back();
      pose.translation_mm = numbers.row(i).head<3>();
      pose.rotation =
          Eigen::Quaterniond(numbers(i, 3), numbers(i, 4), numbers(i, 5), numbers(i, 6));
    }
    return poses;
  });
}

} // namespace phonomime
