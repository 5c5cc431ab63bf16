// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/errors.h"
#include "db/types/progress.h"
#include "tools/app/shard.h"
#include "tools/app/synth.h"

#include <filesystem>
#include <string>
#include <vector>

namespace phonomime {

// Many syntheses, one for each row of a manifest.
struct BatchOptions {
  std::filesystem::path manifest;
  SynthOptions synth; // database and threads of the batch, and what rows leave open; outputs may
                      // hold `{id}`
  Shard shard;        // which rows
  bool redo = false;  // those that are done, too
};

enum class RowStatus {
  done,    // its outputs were written
  skipped, // its outputs were there, and nothing that they depend on has changed
  failed,  // its outputs are as they were
  stopped  // the batch was stopped before
};

// What became of a row.
struct BatchRow {
  long line = 0; // of the manifest
  std::string id;
  std::vector<std::filesystem::path> outputs;
  RowStatus status = RowStatus::stopped;
  ErrorClass error_class = ErrorClass::internal; // where it failed
  std::string error;                             // where it failed: the whole message
  std::vector<std::string> warnings;             // where it is done
  double seconds = 0.0;                          // wall clock
};

struct BatchReport {
  std::vector<BatchRow> rows; // of the shard, in order of the manifest
  double seconds = 0.0;       // wall clock

  std::size_t count(RowStatus status) const;

  // The exit status of a batch in which rows have failed: the greatest of theirs.
  ErrorClass worst_error() const;
};

// Checks the whole manifest, opens the database once, and does every row of the shard that is not
// done yet, several at a time; each gets the bytes that run_synth gives for it, whatever the number
// of threads and the order. A row that fails keeps none of the others from being done; it is in the
// report. Where `progress` asks for a stop, the rows at work are given up, and the report says
// which are left.
//
// Throws what no row can be blamed for: UsageError, InputError and IoError of options, manifest and
// database.
BatchReport run_batch(const BatchOptions& options, const Progress& progress);

} // namespace phonomime
