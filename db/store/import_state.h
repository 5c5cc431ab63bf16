// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/connection.h"
#include "db/store/motion_database.h"
#include "db/store/read_common.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace phonomime::store {

// A running import: the transaction, and the ids of what it has seen so far.
struct ImportState {
  // Opens the transaction; layout and rate are stored or compared. Throws InputError,
  // SQLite::Exception.
  ImportState(std::shared_ptr<Connection> to, Layout its_layout, double rate_hz);

  std::int64_t speaker_id(const std::string& name);
  std::int64_t emotion_id(const std::string& name);
  // Of phonemes that were added: InternalError for others.
  std::int64_t phoneme_id(const Phoneme& phoneme) const;
  std::int64_t silence_id() const;
  // Stores a phoneme or compares it with the one that is there.
  void add_phoneme(const Phoneme& phoneme);
  std::optional<std::int64_t> find_sentence(const std::string& speaker, const std::string& emotion,
                                            const std::string& id) const;
  // In order of (speaker, emotion, id).
  std::vector<std::int64_t> sentence_ids() const;
  // Every sentence has its coefficients and every speaker a reference pose, or InternalError.
  void check_complete() const;

  // Back to journal_mode=DELETE when all else is gone.
  struct EndWriting {
    void operator()(Connection* writing) const { writing->end_writing(); }
  };

  // Destroyed from the last to the first: the transaction is rolled back unless committed.
  std::shared_ptr<Connection> connection;
  std::unique_ptr<Connection, EndWriting> end_writing;
  std::optional<SQLite::Transaction> transaction;
  Layout layout;
  std::int64_t corpus_id = 0;
  std::int64_t added_sentences = 0;
  std::map<std::string, std::int64_t> speaker_ids, emotion_ids;
  std::map<std::string, StoredPhoneme> phonemes;
};

} // namespace phonomime::store
