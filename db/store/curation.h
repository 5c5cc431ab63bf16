// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

enum class CurationAction { prune, restore, undo };

// Which nodes go out of use or come back, and on whose word. Undo needs no nodes: it takes back the
// last prune or restore that is not taken back yet.
struct CurationRequest {
  CurationAction action = CurationAction::prune;
  std::vector<std::string> keys;       // as typed: short forms while they are unique
  std::string by;                      // who; not empty
  std::string reason;                  // why; not empty, but for an undo
  std::vector<std::string> where = {}; // by key, for messages: "keys.txt:3"; may be empty
  bool dry_run = false;                // tell what would be done, change nothing
};

// One line of the journal.
struct JournalEntry {
  std::int64_t id = 0; // 0: of a dry run
  CurationAction action = CurationAction::prune;
  std::string by, at, reason;         // at: UTC, ISO 8601
  std::optional<std::int64_t> undoes; // entry that this undo takes back
  bool undone = false;                // a later undo has taken it back
  std::vector<std::string> keys;      // nodes that it changed, in order of key
};

// How many nodes there are to choose from, pruned ones and those with gaps left out.
struct Coverage {
  struct Cell {
    std::string speaker;
    std::string name; // "aa", "aa happiness", "b-aa-t"
    auto operator<=>(const Cell&) const = default;
  };
  std::map<Cell, std::int64_t> phonemes; // those of the database that were recorded at all
  std::map<Cell, std::int64_t> emotions; // phoneme and emotion
  std::map<Cell, std::int64_t> triphones;
  std::int64_t nodes = 0;
};

struct CurationOutcome {
  std::optional<JournalEntry> entry;  // nothing where no node changed
  std::vector<std::string> unchanged; // keys of those that were as asked for already
  Coverage before, after;
};

} // namespace phonomime
