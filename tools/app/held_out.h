// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/corpus.h"
#include "db/import/survey.h"
#include "db/types/imported_sentence.h"
#include "db/types/motion_table.h"
#include "db/types/progress.h"
#include "tools/app/import_corpus.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace phonomime {

// Recordings, and others that they are to speak.
struct HeldOut {
  std::map<std::string, MotionTable> tables; // by speaker, of those that have held-out sentences
  std::vector<ImportedSentence> sentences;   // in order of (speaker, emotion, id), at the tables'
                                             // rate, head motion off by the tables' poses
  std::vector<std::string> notes;            // sentences that were faulty and left out
};

// Reads the sentences of `corpus` as an import into the database would; nothing of them gets into
// it. Throws InputError: a layout other than the database's, a speaker whom it does not know, and
// what survey_corpus and prepare_recording throw; Interrupted.
HeldOut read_held_out(const std::filesystem::path& database, const Corpus& corpus,
                      const RecordingOptions& options, const Progress& progress);

// Imports the sentences that `held_out` does not take into a new database at `database`, exactly as
// `import` does, and reads those of the others that `spoken` takes. `options.database` and
// `options.takes` are not looked at.
HeldOut hold_out(const ImportOptions& options, const SentenceFilter& held_out,
                 const SentenceFilter& spoken, const std::filesystem::path& database,
                 const Progress& progress);

} // namespace phonomime
