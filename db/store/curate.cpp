// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/curation.h"

#include "db/store/database_impl.h"
#include "db/store/node_keys.h"
#include "db/store/read_common.h"
#include "db/store/store_error.h"
#include "db/store/timestamp.h"
#include "db/types/errors.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace phonomime {
namespace {

using store::Connection;
using store::StoredKey;

constexpr const char* kActionNames[] = {"prune", "restore", "undo"};

CurationAction parse_action(const std::string& name, const Connection& connection) {
  for (const CurationAction action :
       {CurationAction::prune, CurationAction::restore, CurationAction::undo}) {
    if (name == kActionNames[static_cast<std::size_t>(action)]) {
      return action;
    }
  }
  store::throw_damaged(connection.where(), fmt::format("an unknown act \"{}\"", name));
}

Coverage read_coverage(const Connection& connection) {
  Coverage coverage;
  SQLite::Statement select(
      connection.database(),
      "SELECT k.name, before.name, p.name, after.name, e.name, "
      "count(*) FILTER (WHERE n.has_gap = 0 AND g.pruned_by IS NULL) "
      "FROM nodes n JOIN sentences s ON s.id = n.sentence_id JOIN speakers k ON k.id = "
      "s.speaker_id "
      "JOIN phonemes p ON p.id = n.phoneme_id JOIN emotions e ON e.id = n.emotion_id "
      "JOIN phonemes before ON before.id = n.previous_phoneme_id "
      "JOIN phonemes after ON after.id = n.next_phoneme_id "
      "LEFT JOIN prunings g ON g.sentence_id = n.sentence_id AND g.row = n.row "
      "GROUP BY k.name, n.previous_phoneme_id, n.phoneme_id, n.next_phoneme_id, n.emotion_id");
  while (select.executeStep()) {
    const auto text = [&](int column) { return select.getColumn(column).getString(); };
    const std::string speaker = text(0), phoneme = text(2);
    const std::int64_t count = select.getColumn(5).getInt64();
    coverage.phonemes[{speaker, phoneme}] += count;
    coverage.emotions[{speaker, fmt::format("{} {}", phoneme, text(4))}] += count;
    coverage.triphones[{speaker, fmt::format("{}-{}-{}", text(1), phoneme, text(3))}] += count;
    coverage.nodes += count;
  }
  return coverage;
}

// One act within its transaction.
class Curation {
public:
  Curation(const Connection& connection, const CurationRequest& request)
      : connection_(connection), request_(request) {}

  CurationOutcome run() {
    outcome_.before = read_coverage(connection_);
    entry_.action = request_.action;
    entry_.by = request_.by;
    entry_.reason = request_.reason;
    entry_.at = store::timestamp();
    if (request_.action == CurationAction::undo) {
      undo();
    } else {
      change();
    }
    outcome_.after = read_coverage(connection_);
    if (entry_.id != 0) {
      std::ranges::sort(entry_.keys);
      outcome_.entry = std::move(entry_);
    }
    return std::move(outcome_);
  }

private:
  struct Pruning {
    std::string by, at, reason;
  };

  std::optional<Pruning> pruning_of(const StoredKey& node) {
    SQLite::Statement select(connection_.database(),
                             "SELECT pruned_by, pruned_at, reason FROM prunings "
                             "WHERE sentence_id = ? AND row = ?");
    select.bind(1, node.sentence_id);
    select.bind(2, node.row);
    if (!select.executeStep()) {
      return std::nullopt;
    }
    return Pruning{select.getColumn(0).getString(), select.getColumn(1).getString(),
                   select.getColumn(2).getString()};
  }

  void prune(const StoredKey& node, const Pruning& pruning) {
    SQLite::Statement insert(
        connection_.database(),
        "INSERT INTO prunings (sentence_id, row, pruned_by, pruned_at, reason) "
        "VALUES (?, ?, ?, ?, ?)");
    insert.bind(1, node.sentence_id);
    insert.bind(2, node.row);
    insert.bind(3, pruning.by);
    insert.bind(4, pruning.at);
    insert.bind(5, pruning.reason);
    insert.exec();
  }

  void restore(const StoredKey& node) {
    SQLite::Statement remove(connection_.database(),
                             "DELETE FROM prunings WHERE sentence_id = ? AND row = ?");
    remove.bind(1, node.sentence_id);
    remove.bind(2, node.row);
    remove.exec();
  }

  void write_entry(std::optional<std::int64_t> undoes) {
    SQLite::Statement insert(connection_.database(),
                             "INSERT INTO curation_journal (action, done_by, done_at, reason, "
                             "undoes) VALUES (?, ?, ?, ?, ?)");
    insert.bind(1, kActionNames[static_cast<std::size_t>(request_.action)]);
    insert.bind(2, entry_.by);
    insert.bind(3, entry_.at);
    insert.bind(4, entry_.reason);
    if (undoes) {
      insert.bind(5, *undoes);
    }
    insert.exec();
    entry_.id = connection_.database().getLastInsertRowid();
    entry_.undoes = undoes;
  }

  // `ended`: the pruning that a node brought back has had.
  void write_change(const StoredKey& node, const std::optional<Pruning>& ended) {
    SQLite::Statement insert(connection_.database(),
                             "INSERT INTO curation_changes (entry_id, sentence_id, row, pruned_by, "
                             "pruned_at, pruned_reason) VALUES (?, ?, ?, ?, ?, ?)");
    insert.bind(1, entry_.id);
    insert.bind(2, node.sentence_id);
    insert.bind(3, node.row);
    if (ended) {
      insert.bind(4, ended->by);
      insert.bind(5, ended->at);
      insert.bind(6, ended->reason);
    }
    insert.exec();
    entry_.keys.push_back(node.key);
  }

  void change() {
    const bool prunes = request_.action == CurationAction::prune;
    const store::NodeKeys known(connection_);
    std::set<std::string> seen;
    for (std::size_t i = 0; i < request_.keys.size(); ++i) {
      const StoredKey node =
          known.find(request_.keys[i], i < request_.where.size() ? request_.where[i] : "");
      if (!seen.insert(node.key).second) {
        continue;
      }
      const std::optional<Pruning> pruning = pruning_of(node);
      if (pruning.has_value() == prunes) {
        outcome_.unchanged.push_back(node.key);
        continue;
      }
      if (entry_.keys.empty()) {
        write_entry(std::nullopt);
      }
      if (prunes) {
        prune(node, {entry_.by, entry_.at, entry_.reason});
      } else {
        restore(node);
      }
      write_change(node, pruning);
    }
  }

  void undo() {
    SQLite::Statement last(
        connection_.database(),
        "SELECT id FROM curation_journal j WHERE action <> 'undo' AND NOT EXISTS "
        "(SELECT 1 FROM curation_journal u WHERE u.undoes = j.id) "
        "ORDER BY id DESC LIMIT 1");
    if (!last.executeStep()) {
      throw InputError({.where = connection_.where(),
                        .what = "there is nothing to undo",
                        .remedy = "See `phonomime journal DB`."});
    }
    const std::int64_t taken_back = last.getColumn(0).getInt64();
    write_entry(taken_back);
    const store::NodeKeys known(connection_);
    SQLite::Statement changes(connection_.database(),
                              "SELECT sentence_id, row, pruned_by, pruned_at, pruned_reason FROM "
                              "curation_changes WHERE entry_id = ? ORDER BY sentence_id, row");
    changes.bind(1, taken_back);
    while (changes.executeStep()) {
      const StoredKey node =
          known.of(changes.getColumn(0).getInt64(), changes.getColumn(1).getInt());
      const std::optional<Pruning> now = pruning_of(node);
      if (changes.isColumnNull(2)) {
        restore(node);
        write_change(node, now);
      } else if (!now) {
        prune(node, {changes.getColumn(2).getString(), changes.getColumn(3).getString(),
                     changes.getColumn(4).getString()});
        write_change(node, std::nullopt);
      }
    }
  }

  const Connection& connection_;
  const CurationRequest& request_;
  JournalEntry entry_;
  CurationOutcome outcome_;
};

} // namespace

CurationOutcome MotionDatabase::curate(const CurationRequest& request) {
  const Connection& connection = *impl_->connection;
  if (!connection.writable() || request.by.empty() ||
      (request.reason.empty() && request.action != CurationAction::undo)) {
    throw InternalError(
        {.where = connection.where(), .what = "a change without a writer, a name or a reason"});
  }
  return store::translated(connection.where(), [&] {
    SQLite::Transaction transaction(connection.database(), SQLite::TransactionBehavior::IMMEDIATE);
    store::require_settings(connection);
    CurationOutcome outcome = Curation(connection, request).run();
    if (request.dry_run) {
      if (outcome.entry) {
        outcome.entry->id = 0;
      }
    } else if (outcome.entry) {
      transaction.commit();
    }
    return outcome; // rolled back unless committed
  });
}

std::vector<JournalEntry> MotionDatabase::journal() const {
  const Connection& connection = *impl_->connection;
  return store::translated(connection.where(), [&] {
    const store::Snapshot snapshot(connection);
    const store::NodeKeys known(connection);
    SQLite::Statement select(
        connection.database(),
        "SELECT id, action, done_by, done_at, reason, undoes, EXISTS (SELECT 1 FROM "
        "curation_journal u WHERE u.undoes = j.id) FROM curation_journal j ORDER BY id");
    SQLite::Statement changes(
        connection.database(),
        "SELECT sentence_id, row FROM curation_changes WHERE entry_id = ? ORDER BY 1, 2");
    std::vector<JournalEntry> entries;
    while (select.executeStep()) {
      JournalEntry& entry = entries.emplace_back();
      entry.id = select.getColumn(0).getInt64();
      entry.action = parse_action(select.getColumn(1).getString(), connection);
      entry.by = select.getColumn(2).getString();
      entry.at = select.getColumn(3).getString();
      entry.reason = select.getColumn(4).getString();
      if (!select.isColumnNull(5)) {
        entry.undoes = select.getColumn(5).getInt64();
      }
      entry.undone = select.getColumn(6).getInt() != 0;
      changes.reset();
      changes.bind(1, entry.id);
      while (changes.executeStep()) {
        entry.keys.push_back(
            known.of(changes.getColumn(0).getInt64(), changes.getColumn(1).getInt()).key);
      }
      std::ranges::sort(entry.keys);
    }
    return entries;
  });
}

} // namespace phonomime
