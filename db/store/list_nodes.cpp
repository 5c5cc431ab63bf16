// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/database_impl.h"
#include "db/store/read_common.h"
#include "db/store/store_error.h"
#include "db/store/suspects.h"
#include "db/types/text.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

namespace phonomime {
namespace {

constexpr const char* kQuery =
    "SELECT k.name, e.name, s.name, n.row, p.name, p.viseme, before.name, after.name, "
    "r.start_s, r.end_s, n.frame_count, n.has_gap, g.pruned_by IS NOT NULL, g.reason, "
    "n.sentence_id, n.first_frame "
    "FROM nodes n JOIN sentences s ON s.id = n.sentence_id JOIN speakers k ON k.id = s.speaker_id "
    "JOIN emotions e ON e.id = n.emotion_id JOIN phonemes p ON p.id = n.phoneme_id "
    "JOIN phonemes before ON before.id = n.previous_phoneme_id "
    "JOIN phonemes after ON after.id = n.next_phoneme_id "
    "JOIN alignment_rows r ON r.sentence_id = n.sentence_id AND r.row = n.row "
    "LEFT JOIN prunings g ON g.sentence_id = n.sentence_id AND g.row = n.row "
    "WHERE true";

// The query's conditions with the texts that they bind, in order.
struct Conditions {
  std::string sql;
  std::vector<std::string> texts;

  void equal(const char* column, const std::string& text) {
    if (!text.empty()) {
      sql += fmt::format(" AND {} = ?", column);
      texts.push_back(text);
    }
  }
  void flag(const char* condition, const std::optional<bool>& wanted) {
    if (wanted) {
      sql += fmt::format(" AND {}({})", *wanted ? "" : "NOT ", condition);
    }
  }
};

Conditions conditions_of(const NodeFilter& filter) {
  Conditions conditions;
  conditions.equal("p.name", filter.phoneme);
  conditions.equal("e.name", filter.emotion);
  conditions.equal("k.name", filter.speaker);
  conditions.equal("s.name", filter.sentence);
  conditions.equal("before.name", filter.previous_phoneme);
  conditions.equal("after.name", filter.next_phoneme);
  conditions.flag("EXISTS (SELECT 1 FROM suspects m WHERE m.sentence_id = n.sentence_id AND "
                  "m.row = n.row)",
                  filter.suspect);
  conditions.flag("g.pruned_by IS NOT NULL", filter.pruned);
  conditions.flag("n.has_gap = 1", filter.has_gap);
  return conditions;
}

// A name that the database does not know would find nothing, which says less than its neighbours.
void check_name(const store::Connection& connection, const char* kind, const char* table,
                const std::string& name) {
  constexpr std::size_t kMostListed = 80;
  if (name.empty()) {
    return;
  }
  std::vector<std::string> known = store::names_of(store::read_names(connection, table));
  known.erase(std::unique(known.begin(), known.end()), known.end());
  if (std::ranges::find(known, name) != known.end()) {
    return;
  }
  const bool lists_them = !known.empty() && known.size() <= kMostListed;
  throw InputError({.where = connection.where(),
                    .what = fmt::format("{} {} is not in this database", kind, quoted(name)),
                    .expected = lists_them ? fmt::format("one of {}", fmt::join(known, ", ")) : "",
                    .remedy = did_you_mean(name, known)});
}

void check_names(const store::Connection& connection, const NodeFilter& filter) {
  check_name(connection, "phoneme", "phonemes", filter.phoneme);
  check_name(connection, "phoneme", "phonemes", filter.previous_phoneme);
  check_name(connection, "phoneme", "phonemes", filter.next_phoneme);
  check_name(connection, "emotion", "emotions", filter.emotion);
  check_name(connection, "speaker", "speakers", filter.speaker);
  check_name(connection, "sentence", "sentences", filter.sentence);
}

} // namespace

std::vector<NodeRecord> MotionDatabase::list_nodes(const NodeFilter& filter) const {
  const store::Connection& connection = *impl_->connection;
  return store::translated(connection.where(), [&] {
    const store::Snapshot snapshot(connection);
    check_names(connection, filter);
    const Conditions conditions = conditions_of(filter);
    SQLite::Statement statement(
        connection.database(), kQuery + conditions.sql + " ORDER BY k.name, e.name, s.name, n.row");
    int index = 0;
    for (const std::string& text : conditions.texts) {
      statement.bind(++index, text);
    }
    store::SuspectReader marks(connection);
    std::vector<NodeRecord> records;
    while (statement.executeStep()) {
      NodeRecord& record = records.emplace_back();
      record.speaker = statement.getColumn(0).getString();
      record.emotion = statement.getColumn(1).getString();
      record.sentence = statement.getColumn(2).getString();
      const int row = statement.getColumn(3).getInt();
      record.key = fmt::format("{}/{}/{}#{}", record.speaker, record.emotion, record.sentence, row);
      record.phoneme = statement.getColumn(4).getString();
      record.viseme = statement.getColumn(5).getString();
      record.previous_phoneme = statement.getColumn(6).getString();
      record.next_phoneme = statement.getColumn(7).getString();
      record.start_s = statement.getColumn(8).getDouble();
      record.end_s = statement.getColumn(9).getDouble();
      record.frame_count = statement.getColumn(10).getInt();
      record.has_gap = statement.getColumn(11).getInt() != 0;
      record.pruned = statement.getColumn(12).getInt() != 0;
      record.pruned_reason = record.pruned ? statement.getColumn(13).getString() : "";
      record.first_frame = statement.getColumn(15).getInt64();
      record.suspect = marks.read(statement.getColumn(14).getInt64(), row);
    }
    return records;
  });
}

} // namespace phonomime
