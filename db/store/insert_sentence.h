// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/import_state.h"
#include "db/types/imported_sentence.h"

namespace phonomime::store {

// Everything of one sentence but its coefficients. As ImportTransaction::add_sentence; also throws
// SQLite::Exception.
void insert_sentence(ImportState& import, const ImportedSentence& sentence);

} // namespace phonomime::store
