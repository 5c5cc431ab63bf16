// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/connection.h"
#include "db/types/layout.h"
#include "db/types/node_marks.h"
#include "db/types/stored_sentence.h"

#include <SQLiteCpp/Statement.h>

#include <functional>
#include <vector>

// Suspects and what they are judged by. All throw SQLite::Exception, and InputError where the
// content is not what the schema promises.
namespace phonomime::store {

// Every sentence in order of (speaker, emotion, id).
void for_each_stored_sentence(const Connection& connection, const Layout& layout,
                              const std::function<void(const StoredSentence&)>& visit);

// Writes a mark of a node, but for one of the channels where the recording shows the same.
class SuspectWriter {
public:
  explicit SuspectWriter(const Connection& connection);
  void write(std::int64_t sentence_id, std::int32_t row, const SuspectMark& mark);

private:
  SQLite::Statement insert_;
};

// Puts `marks` in the place of all that the channels showed before.
void replace_channel_suspects(const Connection& connection, const std::vector<NodeMarks>& marks);

// A node's marks, by reason.
class SuspectReader {
public:
  explicit SuspectReader(const Connection& connection);
  std::vector<SuspectMark> read(std::int64_t sentence_id, std::int32_t row);

private:
  const Connection& connection_;
  SQLite::Statement select_;
};

} // namespace phonomime::store
