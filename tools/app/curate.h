// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/motion_database.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

inline constexpr std::int64_t kUsuallyThin = 5;

struct CurateOptions {
  std::filesystem::path database;
  CurationAction action = CurationAction::prune;
  std::vector<std::string> keys;    // as typed
  std::filesystem::path from;       // file of keys, "-": standard input; empty: none
  std::optional<NodeFilter> filter; // nodes that fit it, but for those that are as asked for
  std::string by;                   // empty: the user's name
  std::string reason;
  std::int64_t thin_below = kUsuallyThin; // nodes; 0: nothing is thin
  bool dry_run = false;
};

// A part of the database that has lost or gained nodes and is, or was, thin.
struct ThinPart {
  std::string kind; // "phoneme", "emotion", "triphone"
  std::string speaker, name;
  std::int64_t before = 0, after = 0; // nodes in use
};

struct CurateReport {
  CurationOutcome outcome;
  std::vector<ThinPart> thin; // in order of (kind, fewest after, speaker, name)
};

// Prunes, restores or undoes, and tells what that does to coverage. Throws UsageError (no node is
// named), InputError and IoError.
CurateReport run_curation(const CurateOptions& options);

// Keys of a text: one a line, the first field where a line is one of a table (tabs or commas, as
// `nodes` and `suspects` print it); a first line that heads a table, empty lines and lines that
// begin with # are passed over.
struct TypedKey {
  std::string key;
  std::string where; // "file:line"
};
std::vector<TypedKey> parse_keys(std::string_view text, std::string_view where);

} // namespace phonomime
