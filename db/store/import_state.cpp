// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/import_state.h"

#include "db/store/store_error.h"
#include "db/types/text.h"

#include <fmt/format.h>

#include <algorithm>

namespace phonomime::store {
namespace {

// The first thing in which a corpus' layout differs from the database's, for people.
struct Difference {
  std::string what, expected, got;
};

Difference first_difference(const Layout& known, const Layout& offered) {
  const auto kind = [](const Layout& layout) {
    return layout.kind == LayoutKind::markers ? "markers" : "weights";
  };
  if (known.kind != offered.kind) {
    return {"kind", kind(known), kind(offered)};
  }
  if (known.scale != offered.scale) {
    const auto scale = [](const Layout& layout) {
      return layout.scale ? std::string(kScaleNames[static_cast<std::size_t>(*layout.scale)])
                          : std::string("not said");
    };
    return {"scale", scale(known), scale(offered)};
  }
  for (int i = 0; i < std::min(known.group_count(), offered.group_count()); ++i) {
    const ChannelGroup& ours = known.groups[static_cast<std::size_t>(i)];
    const ChannelGroup& theirs = offered.groups[static_cast<std::size_t>(i)];
    if (ours.name != theirs.name) {
      return {fmt::format("channel group {}", i), quoted(ours.name), quoted(theirs.name)};
    }
    if (ours.regions != theirs.regions) {
      return {fmt::format("regions of {}", quoted(ours.name)), "the same regions", "others"};
    }
  }
  if (known.group_count() != offered.group_count()) {
    return {"number of channel groups", std::to_string(known.group_count()),
            std::to_string(offered.group_count())};
  }
  return {"reference group or landmarks", "the same ones", "others"};
}

void store_or_compare_settings(const Connection& connection, const Layout& layout, double rate_hz) {
  const std::optional<Settings> known = read_settings(connection);
  const std::string text = format_layout(layout);
  if (!known) {
    SQLite::Statement insert(connection.database(),
                             "INSERT INTO settings (id, rate_hz, layout_json) VALUES (1, ?, ?)");
    insert.bind(1, rate_hz);
    insert.bind(2, text);
    insert.exec();
    return;
  }
  if (format_layout(known->layout) != text) {
    const Difference difference = first_difference(known->layout, layout);
    throw InputError(
        {.where = connection.where(),
         .what = fmt::format("the corpus' layout is not the database's: {}", difference.what),
         .expected = difference.expected,
         .got = difference.got,
         .remedy = "Import it into a database of its own."});
  }
  if (known->rate_hz != rate_hz) {
    throw InputError({.where = connection.where(),
                      .what = "the corpus' frame rate is not the database's",
                      .expected = fmt::format("{} Hz", format_number(known->rate_hz)),
                      .got = fmt::format("{} Hz", format_number(rate_hz)),
                      .remedy = "Resample to the database's rate, or import into another one."});
  }
}

std::int64_t insert_name(const Connection& connection, const char* table, const std::string& name) {
  SQLite::Statement insert(connection.database(),
                           fmt::format("INSERT INTO {} (name) VALUES (?)", table));
  insert.bind(1, name);
  insert.exec();
  return connection.database().getLastInsertRowid();
}

std::map<std::string, std::int64_t> ids_by_name(const Connection& connection, const char* table) {
  std::map<std::string, std::int64_t> ids;
  for (const NamedRow& row : read_names(connection, table)) {
    ids[row.name] = row.id;
  }
  return ids;
}

} // namespace

ImportState::ImportState(std::shared_ptr<Connection> to, Layout its_layout, double rate_hz)
    : connection(std::move(to)), layout(std::move(its_layout)) {
  end_writing.reset(connection.get());
  connection->begin_writing();
  transaction.emplace(connection->database(), SQLite::TransactionBehavior::IMMEDIATE);
  store_or_compare_settings(*connection, layout, rate_hz);
  corpus_id =
      connection->database().execAndGet("SELECT coalesce(max(id), 0) + 1 FROM corpora").getInt64();
  speaker_ids = ids_by_name(*connection, "speakers");
  emotion_ids = ids_by_name(*connection, "emotions");
  for (const StoredPhoneme& stored : read_phonemes(*connection)) {
    phonemes[stored.phoneme.name] = stored;
  }
}

std::int64_t ImportState::speaker_id(const std::string& name) {
  const auto found = speaker_ids.find(name);
  return found != speaker_ids.end()
             ? found->second
             : speaker_ids[name] = insert_name(*connection, "speakers", name);
}

std::int64_t ImportState::emotion_id(const std::string& name) {
  const auto found = emotion_ids.find(name);
  return found != emotion_ids.end()
             ? found->second
             : emotion_ids[name] = insert_name(*connection, "emotions", name);
}

std::int64_t ImportState::phoneme_id(const Phoneme& phoneme) const {
  const auto found = phonemes.find(phoneme.name);
  if (found == phonemes.end() || found->second.phoneme != phoneme) {
    throw InternalError(
        {.where = connection->where(),
         .what = fmt::format("phoneme {} was not added to the import", quoted(phoneme.name))});
  }
  return found->second.id;
}

std::int64_t ImportState::silence_id() const {
  const auto found = phonemes.find(std::string(kSilence));
  if (found == phonemes.end()) {
    throw InternalError(
        {.where = connection->where(), .what = "silence was not added to the import"});
  }
  return found->second.id;
}

void ImportState::add_phoneme(const Phoneme& phoneme) {
  const auto found = phonemes.find(phoneme.name);
  if (found != phonemes.end()) {
    const auto describe = [](const Phoneme& described) {
      return fmt::format("viseme {}, visibility {}", quoted(described.viseme),
                         visibility_name(described.visibility));
    };
    const Phoneme& known = found->second.phoneme;
    if (known != phoneme) {
      throw InputError({.where = connection->where(),
                        .what = fmt::format("the corpus' phoneme set describes {} otherwise than "
                                            "the database does",
                                            quoted(phoneme.name)),
                        .expected = describe(known),
                        .got = describe(phoneme),
                        .remedy = "Use the same phoneme set, or a database of its own."});
    }
    return;
  }
  SQLite::Statement insert(connection->database(),
                           "INSERT INTO phonemes (name, viseme, visibility) VALUES (?, ?, ?)");
  insert.bind(1, phoneme.name);
  insert.bind(2, phoneme.viseme);
  insert.bind(3, visibility_name(phoneme.visibility));
  insert.exec();
  phonemes[phoneme.name] = {connection->database().getLastInsertRowid(), phoneme};
}

std::optional<std::int64_t> ImportState::find_sentence(const std::string& speaker,
                                                       const std::string& emotion,
                                                       const std::string& id) const {
  const auto speaker_found = speaker_ids.find(speaker);
  const auto emotion_found = emotion_ids.find(emotion);
  if (speaker_found == speaker_ids.end() || emotion_found == emotion_ids.end()) {
    return std::nullopt;
  }
  SQLite::Statement select(
      connection->database(),
      "SELECT id FROM sentences WHERE speaker_id = ? AND emotion_id = ? AND name = ?");
  select.bind(1, speaker_found->second);
  select.bind(2, emotion_found->second);
  select.bind(3, id);
  if (!select.executeStep()) {
    return std::nullopt;
  }
  return select.getColumn(0).getInt64();
}

std::vector<std::int64_t> ImportState::sentence_ids() const {
  SQLite::Statement select(
      connection->database(),
      "SELECT s.id FROM sentences s JOIN speakers k ON k.id = s.speaker_id "
      "JOIN emotions e ON e.id = s.emotion_id ORDER BY k.name, e.name, s.name");
  std::vector<std::int64_t> ids;
  while (select.executeStep()) {
    ids.push_back(select.getColumn(0).getInt64());
  }
  return ids;
}

void ImportState::check_complete() const {
  const auto require_none = [&](const char* query, const char* what) {
    if (connection->database().execAndGet(query).getInt64() != 0) {
      throw InternalError({.where = connection->where(), .what = what});
    }
  };
  require_none("SELECT count(*) FROM speakers WHERE reference_pose IS NULL",
               "a speaker's reference pose is to be set before commit");
  require_none("SELECT count(*) FROM sentences WHERE id NOT IN (SELECT sentence_id FROM "
               "coefficients)",
               "the PCA is to be set after the last sentence and before commit");
}

} // namespace phonomime::store
