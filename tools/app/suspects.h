// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/motion_database.h"
#include "db/types/progress.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace phonomime {

struct SuspectsOptions {
  std::filesystem::path database;
  NodeFilter filter;        // `suspect` and `pruned` are set by what follows
  std::string reason;       // of kSuspectReasons; empty: any
  bool with_pruned = false; // those too that are out of use already
  bool judge = false;       // first judge the stored channels anew, and keep the marks
  std::size_t limit = 0;    // 0: all
  int threads = 0;          // 0: as many as there are cores
};

// A suspect node. `score` is that of its worst mark (of the reason that was asked for).
struct RankedSuspect {
  NodeRecord node;
  double score = 0.0;
};

struct SuspectsReport {
  std::vector<RankedSuspect> suspects; // worst first, then in order of key
  std::size_t found = 0;               // before the limit
  double rate_hz = 0.0;                // of the frames that marks name
};

// Throws UsageError (unknown reason, with the nearest), InputError, IoError and Interrupted.
SuspectsReport list_suspects(const SuspectsOptions& options, const Progress& progress);

} // namespace phonomime
