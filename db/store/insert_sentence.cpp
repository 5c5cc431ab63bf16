// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/insert_sentence.h"

#include "db/store/blobs.h"
#include "db/store/check_sentence.h"
#include "db/store/suspects.h"
#include "db/types/text.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <array>
#include <vector>

namespace phonomime::store {
namespace {

std::int64_t insert_head_row(ImportState& import, const ImportedSentence& sentence) {
  SQLite::Statement insert(import.connection->database(),
                           "INSERT INTO sentences (corpus_id, speaker_id, emotion_id, name, text, "
                           "audio, frame_count) VALUES (?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, import.corpus_id);
  insert.bind(2, import.speaker_id(sentence.speaker));
  insert.bind(3, import.emotion_id(sentence.emotion));
  insert.bind(4, sentence.id);
  insert.bind(5, sentence.text);
  insert.bind(6, sentence.audio);
  insert.bind(7, static_cast<std::int64_t>(sentence.channels.rows()));
  insert.exec();
  return import.connection->database().getLastInsertRowid();
}

void insert_rows(const ImportState& import, const ImportedSentence& sentence, std::int64_t id) {
  SQLite::Statement insert(import.connection->database(),
                           "INSERT INTO alignment_rows (sentence_id, row, phoneme_id, start_s, "
                           "end_s) VALUES (?, ?, ?, ?, ?)");
  std::int64_t index = 0;
  for (const TimedPhoneme& row : sentence.rows) {
    insert.reset();
    insert.bind(1, id);
    insert.bind(2, index++);
    insert.bind(3, import.phoneme_id(row.phoneme));
    insert.bind(4, row.start_s);
    insert.bind(5, row.end_s);
    insert.exec();
  }
}

void insert_nodes(ImportState& import, const ImportedSentence& sentence, std::int64_t id) {
  SQLite::Statement insert(
      import.connection->database(),
      "INSERT INTO nodes (sentence_id, row, first_frame, frame_count, phoneme_id, "
      "previous_phoneme_id, next_phoneme_id, emotion_id, has_gap) VALUES (?, ?, ?, ?, ?, ?, ?, ?, "
      "?)");
  SuspectWriter marks(*import.connection);
  const auto phoneme_of_row = [&](std::int64_t row) {
    return row >= 0 && row < static_cast<std::int64_t>(sentence.rows.size())
               ? import.phoneme_id(sentence.rows[static_cast<std::size_t>(row)].phoneme)
               : import.silence_id();
  };
  for (const ImportedNode& node : sentence.nodes) {
    insert.reset();
    insert.bind(1, id);
    insert.bind(2, node.row);
    insert.bind(3, node.first_frame);
    insert.bind(4, node.frame_count);
    insert.bind(5, phoneme_of_row(node.row));
    insert.bind(6, phoneme_of_row(std::int64_t{node.row} - 1));
    insert.bind(7, phoneme_of_row(std::int64_t{node.row} + 1));
    insert.bind(8, import.emotion_id(sentence.emotion));
    insert.bind(9, node.has_gap ? 1 : 0);
    insert.exec();
    for (const SuspectMark& mark : node.suspect) {
      marks.write(id, node.row, mark);
    }
  }
}

void insert_channels(const ImportState& import, const ImportedSentence& sentence, std::int64_t id) {
  SQLite::Statement insert(
      import.connection->database(),
      "INSERT INTO channels (sentence_id, frames, frame_has_gap) VALUES (?, ?, ?)");
  insert.bind(1, id);
  bind_numbers(
      insert, 2,
      std::span(sentence.channels.data(), static_cast<std::size_t>(sentence.channels.size())));
  bind_numbers(insert, 3, std::span(sentence.frame_has_gap));
  insert.exec();
}

void insert_head(const ImportState& import, const ImportedSentence& sentence, std::int64_t id) {
  std::vector<std::array<double, 7>> poses;
  for (const HeadPose& pose : sentence.head) {
    const Eigen::Vector3d& t = pose.translation_mm;
    const Eigen::Quaterniond& r = pose.rotation;
    poses.push_back({t.x(), t.y(), t.z(), r.w(), r.x(), r.y(), r.z()});
  }
  SQLite::Statement insert(import.connection->database(),
                           "INSERT INTO head_poses (sentence_id, poses) VALUES (?, ?)");
  insert.bind(1, id);
  bind_numbers(insert, 2, std::span(poses));
  insert.exec();
}

} // namespace

void insert_sentence(ImportState& import, const ImportedSentence& sentence) {
  check_sentence(sentence, import.layout);
  if (import.find_sentence(sentence.speaker, sentence.emotion, sentence.id)) {
    throw InputError({.where = import.connection->where(),
                      .what = fmt::format("sentence {}/{}/{} is in the database already",
                                          sentence.speaker, sentence.emotion, sentence.id),
                      .expected = "every (speaker, emotion, id) once",
                      .remedy = "Rename or leave out the sentence, or import into a new file."});
  }
  const std::int64_t id = insert_head_row(import, sentence);
  insert_rows(import, sentence, id);
  insert_nodes(import, sentence, id);
  insert_channels(import, sentence, id);
  if (!sentence.head.empty()) {
    insert_head(import, sentence, id);
  }
  ++import.added_sentences;
}

} // namespace phonomime::store
