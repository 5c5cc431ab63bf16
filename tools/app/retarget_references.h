// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/mapping/reference_frames.h"

#include <filesystem>
#include <string>

namespace phonomime {

struct RetargetReferencesOptions {
  std::filesystem::path database;
  std::string speaker; // may be empty where the database holds only one
  std::filesystem::path face;
  std::filesystem::path output; // a pair table
  ReferenceOptions references;
};

struct ReferencesReport {
  std::size_t frames = 0;
  std::size_t extremes = 0; // of them
  std::size_t shapes = 0;
  bool fitted = false;  // weights are those of a direct fit; else zeros
  std::string farthest; // key of the node that is farthest from all of them
  ReferenceCoverage coverage;
};

// Proposes frames of a database for cross-mapping and writes the pair table
// (corpora_schema/pairs.md), with the weights of a direct fit where the database is of markers.
// Throws UsageError, InputError and IoError.
ReferencesReport propose_pairs(const RetargetReferencesOptions& options);

} // namespace phonomime
