// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/connection.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace phonomime::store {

// A node as the file knows it.
struct StoredKey {
  std::int64_t sentence_id = 0;
  std::int32_t row = 0;
  std::string key; // in full
};

// Typed keys to nodes, of all speakers, pruned ones and those with gaps too.
class NodeKeys {
public:
  explicit NodeKeys(const Connection& connection);

  // The node of a key, or of a shorter form while that is unique. Throws InputError (no key,
  // unknown, ambiguous) with the nearest candidates; `where` names the place where it was typed, or
  // is empty.
  StoredKey find(std::string_view typed, const std::string& where) const;

  StoredKey of(std::int64_t sentence_id, std::int32_t row) const;

private:
  bool has_node(std::int64_t sentence_id, std::int32_t row) const;
  std::vector<std::string> near_keys(std::string_view sentence, std::int32_t row) const;

  const Connection& connection_;
  std::unordered_map<std::int64_t, std::string> keys_;                   // of sentences, by id
  std::unordered_map<std::string, std::vector<std::int64_t>> sentences_; // by every form of a key
  std::vector<std::string> forms_; // of sentences, for candidates: as short as is unique
};

} // namespace phonomime::store
