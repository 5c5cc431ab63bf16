// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/suspects.h"

#include "db/store/database_impl.h"
#include "db/store/read_common.h"
#include "db/store/refit.h"
#include "db/store/store_error.h"

#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace phonomime {
namespace store {
namespace {

constexpr const char* kOrigins[] = {"recording", "channels"};

std::vector<StoredSentence::Node> read_nodes(SQLite::Statement& select, std::int64_t sentence_id,
                                             std::int64_t frame_count,
                                             const Connection& connection) {
  select.reset();
  select.bind(1, sentence_id);
  std::vector<StoredSentence::Node> nodes;
  while (select.executeStep()) {
    StoredSentence::Node node;
    node.row = select.getColumn(0).getInt();
    node.phoneme = select.getColumn(1).getString();
    node.duration_s = select.getColumn(2).getDouble();
    const std::int64_t first = select.getColumn(3).getInt64();
    const std::int64_t count = select.getColumn(4).getInt64();
    if (first < 0 || count < 1 || count > frame_count || first > frame_count - count) {
      throw_damaged(connection.where(), "a node's frames outside its sentence");
    }
    node.first_frame = static_cast<std::int32_t>(first);
    node.frame_count = static_cast<std::int32_t>(count);
    node.has_gap = select.getColumn(5).getInt() != 0;
    node.pruned = select.getColumn(6).getInt() != 0;
    nodes.push_back(std::move(node));
  }
  return nodes;
}

} // namespace

void for_each_stored_sentence(const Connection& connection, const Layout& layout,
                              const std::function<void(const StoredSentence&)>& visit) {
  SQLite::Statement sentences(
      connection.database(),
      "SELECT s.id, k.name, e.name, s.name FROM sentences s JOIN speakers k ON k.id = s.speaker_id "
      "JOIN emotions e ON e.id = s.emotion_id ORDER BY k.name, e.name, s.name");
  SQLite::Statement nodes(
      connection.database(),
      "SELECT n.row, p.name, r.end_s - r.start_s, n.first_frame, n.frame_count, n.has_gap, "
      "g.pruned_by IS NOT NULL FROM nodes n JOIN phonemes p ON p.id = n.phoneme_id "
      "JOIN alignment_rows r ON r.sentence_id = n.sentence_id AND r.row = n.row "
      "LEFT JOIN prunings g ON g.sentence_id = n.sentence_id AND g.row = n.row "
      "WHERE n.sentence_id = ? ORDER BY n.row");
  ChannelReader channels(connection, layout.channel_count());
  while (sentences.executeStep()) {
    StoredSentence sentence;
    sentence.id = sentences.getColumn(0).getInt64();
    sentence.speaker = sentences.getColumn(1).getString();
    sentence.emotion = sentences.getColumn(2).getString();
    sentence.name = sentences.getColumn(3).getString();
    sentence.channels = channels.read(sentence.id);
    sentence.frame_has_gap = channels.frame_has_gap(sentence.channels.rows());
    sentence.nodes = read_nodes(nodes, sentence.id, sentence.channels.rows(), connection);
    visit(sentence);
  }
}

SuspectWriter::SuspectWriter(const Connection& connection)
    : insert_(connection.database(),
              "INSERT INTO suspects (sentence_id, row, reason, origin, score, first_frame, "
              "frame_count, groups_json, text) SELECT ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9 "
              "WHERE ?4 = 'recording' OR NOT EXISTS (SELECT 1 FROM suspects WHERE "
              "sentence_id = ?1 AND row = ?2 AND reason = ?3 AND origin = 'recording')") {}

void SuspectWriter::write(std::int64_t sentence_id, std::int32_t row, const SuspectMark& mark) {
  insert_.reset();
  insert_.bind(1, sentence_id);
  insert_.bind(2, row);
  insert_.bind(3, mark.reason);
  insert_.bind(4, kOrigins[static_cast<std::size_t>(mark.origin)]);
  insert_.bind(5, mark.score);
  insert_.bind(6, mark.first_frame);
  insert_.bind(7, mark.frame_count);
  insert_.bind(8, nlohmann::json(mark.groups).dump());
  insert_.bind(9, mark.text);
  insert_.exec();
}

void replace_channel_suspects(const Connection& connection, const std::vector<NodeMarks>& marks) {
  connection.database().exec("DELETE FROM suspects WHERE origin = 'channels'");
  SuspectWriter writer(connection);
  for (const NodeMarks& node : marks) {
    for (const SuspectMark& mark : node.marks) {
      writer.write(node.sentence_id, node.row, mark);
    }
  }
}

SuspectReader::SuspectReader(const Connection& connection)
    : connection_(connection),
      select_(connection.database(),
              "SELECT reason, origin, score, first_frame, frame_count, groups_json, text "
              "FROM suspects WHERE sentence_id = ? AND row = ? ORDER BY reason, origin") {}

std::vector<SuspectMark> SuspectReader::read(std::int64_t sentence_id, std::int32_t row) {
  select_.reset();
  select_.bind(1, sentence_id);
  select_.bind(2, row);
  std::vector<SuspectMark> marks;
  while (select_.executeStep()) {
    SuspectMark& mark = marks.emplace_back();
    mark.reason = select_.getColumn(0).getString();
    mark.origin = select_.getColumn(1).getString() == kOrigins[0] ? SuspectOrigin::recording
                                                                  : SuspectOrigin::channels;
    mark.score = select_.getColumn(2).getDouble();
    mark.first_frame = select_.getColumn(3).getInt();
    mark.frame_count = select_.getColumn(4).getInt();
    const nlohmann::json groups =
        nlohmann::json::parse(select_.getColumn(5).getString(), nullptr, false);
    const bool names = groups.is_array() && std::ranges::all_of(groups, [](const auto& group) {
                         return group.is_string();
                       });
    if (!names || !std::isfinite(mark.score)) {
      throw_damaged(connection_.where(), "a suspect whose mark cannot be read");
    }
    mark.groups = groups.get<std::vector<std::string>>();
    mark.text = select_.getColumn(6).getString();
  }
  return marks;
}

} // namespace store

void MotionDatabase::for_each_stored_sentence(
    const std::function<void(const StoredSentence&)>& visit) const {
  const store::Connection& connection = *impl_->connection;
  store::translated(connection.where(), [&] {
    const store::Snapshot snapshot(connection);
    store::for_each_stored_sentence(connection, store::require_settings(connection).layout, visit);
  });
}

void MotionDatabase::replace_channel_suspects(
    const std::function<std::vector<NodeMarks>(MotionDatabase&)>& judge) {
  const store::Connection& connection = *impl_->connection;
  store::translated(connection.where(), [&] {
    // The lock is taken first, so that what is judged is what is there when the marks go in.
    SQLite::Transaction transaction(connection.database(), SQLite::TransactionBehavior::IMMEDIATE);
    store::replace_channel_suspects(connection, judge(*this));
    transaction.commit();
  });
}

} // namespace phonomime
