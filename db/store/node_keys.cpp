// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/node_keys.h"

#include "db/store/store_error.h"
#include "db/types/text.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace phonomime::store {
namespace {

constexpr std::size_t kShownCandidates = 3;

std::string node_key(const std::string& sentence, std::int32_t row) {
  return fmt::format("{}#{}", sentence, row);
}

} // namespace

NodeKeys::NodeKeys(const Connection& connection) : connection_(connection) {
  SQLite::Statement select(
      connection.database(),
      "SELECT s.id, k.name, e.name, s.name FROM sentences s JOIN speakers k ON k.id = s.speaker_id "
      "JOIN emotions e ON e.id = s.emotion_id ORDER BY k.name, e.name, s.name");
  while (select.executeStep()) {
    const std::int64_t id = select.getColumn(0).getInt64();
    const std::string key =
        fmt::format("{}/{}/{}", select.getColumn(1).getString(), select.getColumn(2).getString(),
                    select.getColumn(3).getString());
    // Every end of the key that begins where a part of it does.
    for (std::size_t at = 0; at != std::string::npos;) {
      sentences_[key.substr(at)].push_back(id);
      const std::size_t slash = key.find('/', at);
      at = slash == std::string::npos ? slash : slash + 1;
    }
    forms_.push_back(key);
    forms_.push_back(select.getColumn(3).getString());
    keys_[id] = key;
  }
}

bool NodeKeys::has_node(std::int64_t sentence_id, std::int32_t row) const {
  SQLite::Statement select(connection_.database(),
                           "SELECT 1 FROM nodes WHERE sentence_id = ? AND row = ?");
  select.bind(1, sentence_id);
  select.bind(2, row);
  return select.executeStep();
}

std::vector<std::string> NodeKeys::near_keys(std::string_view sentence, std::int32_t row) const {
  std::vector<std::string> keys;
  SQLite::Statement select(connection_.database(), "SELECT row FROM nodes WHERE sentence_id = ? "
                                                   "ORDER BY abs(row - ?), row LIMIT 3");
  const auto add = [&](std::int64_t id, std::size_t most) {
    select.reset();
    select.bind(1, id);
    select.bind(2, row);
    for (std::size_t i = 0; i < most && select.executeStep(); ++i) {
      keys.push_back(node_key(keys_.at(id), select.getColumn(0).getInt()));
    }
  };
  const auto known = sentences_.find(std::string(sentence));
  if (known != sentences_.end()) {
    for (std::size_t i = 0; i < std::min(kShownCandidates, known->second.size()); ++i) {
      add(known->second[i], known->second.size() == 1 ? kShownCandidates : 1);
    }
    return keys;
  }
  for (const std::string& form : nearest_candidates(sentence, forms_, kShownCandidates)) {
    add(sentences_.at(form).front(), 1);
  }
  return keys;
}

StoredKey NodeKeys::find(std::string_view typed, const std::string& where) const {
  const std::string place = where.empty() ? connection_.where() : where;
  const std::size_t hash = typed.rfind('#');
  const std::optional<long> row = hash == std::string_view::npos || hash == 0
                                      ? std::nullopt
                                      : parse_integer(typed.substr(hash + 1));
  if (!row || *row < 0 || *row > std::numeric_limits<std::int32_t>::max()) {
    throw InputError(
        {.where = place,
         .what = fmt::format("{} is not the key of a motion node", quoted(typed)),
         .expected = "speaker/emotion/sentence#order, or an end of it from sentence on"});
  }
  const auto order = static_cast<std::int32_t>(*row);
  const std::string_view sentence = typed.substr(0, hash);
  std::vector<StoredKey> found;
  if (const auto known = sentences_.find(std::string(sentence)); known != sentences_.end()) {
    for (const std::int64_t id : known->second) {
      if (has_node(id, order)) {
        found.push_back({id, order, node_key(keys_.at(id), order)});
      }
    }
  }
  if (found.size() == 1) {
    return found.front();
  }
  std::vector<std::string> keys;
  if (found.empty()) {
    keys = near_keys(sentence, order);
    throw InputError({.where = place,
                      .what = fmt::format("there is no motion node {}", quoted(typed)),
                      .remedy = keys.empty()
                                    ? "List them with `phonomime nodes DB`."
                                    : fmt::format("Did you mean {}?", fmt::join(keys, " or "))});
  }
  for (std::size_t i = 0; i < std::min(kShownCandidates, found.size()); ++i) {
    keys.push_back(found[i].key);
  }
  throw InputError({.where = place,
                    .what = fmt::format("{} is ambiguous: {} motion nodes have that key",
                                        quoted(typed), found.size()),
                    .remedy = fmt::format("Write one of them in full: {}{}", fmt::join(keys, ", "),
                                          found.size() > keys.size() ? ", ..." : "")});
}

StoredKey NodeKeys::of(std::int64_t sentence_id, std::int32_t row) const {
  const auto key = keys_.find(sentence_id);
  if (key == keys_.end()) {
    throw_damaged(connection_.where(), "a node of a sentence that is not there");
  }
  return {sentence_id, row, node_key(key->second, row)};
}

} // namespace phonomime::store
