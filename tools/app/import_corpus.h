// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/corpus.h"
#include "db/import/pca.h"
#include "db/import/report.h"
#include "db/import/survey.h"
#include "db/types/progress.h"

#include <filesystem>

namespace phonomime {

struct ImportOptions {
  std::filesystem::path corpus;   // folder
  std::filesystem::path database; // new, or added to
  double rate_hz = 0.0; // of a new database, 10 to 1000; 0: the fastest recording's, at least 100
  PcaSize pca;
  RecordingOptions recordings; // gap limit, tolerance, faulty sentences, threads
  SentenceFilter takes;        // which sentences of the corpus; empty: all

  // Throws UsageError, which says what is out of range.
  void validate() const;
};

// A corpus folder into a motion database, in one transaction: read_corpus, survey_corpus, then each
// recording prepared and stored in order, and the PCA fitted to every frame of the database. An
// error, a stop or a kill at any moment leaves the database as it was. Throws UsageError,
// InputError, IoError and Interrupted.
ImportReport import_corpus(const ImportOptions& options, const Progress& progress);

} // namespace phonomime
