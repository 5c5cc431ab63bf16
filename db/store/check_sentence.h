// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/imported_sentence.h"
#include "db/types/layout.h"

namespace phonomime::store {

// What the store takes for granted when it reads a sentence back: shapes agree, numbers are finite,
// nodes lie in order of row and time, within the frames, apart, and none is silence.
// Throws InternalError, for a sentence that breaks it is the importer's mistake, not a user's.
void check_sentence(const ImportedSentence& sentence, const Layout& layout);

} // namespace phonomime::store
