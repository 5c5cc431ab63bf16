// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/node_marks.h"
#include "db/types/progress.h"
#include "db/types/stored_sentence.h"

#include <functional>
#include <vector>

namespace phonomime {

// Calls `visit` with every sentence of a database, in order: it is gone through twice.
using EachStoredSentence =
    std::function<void(const std::function<void(const StoredSentence&)>& visit)>;

// The suspects of a database by its stored channels (SuspectJudge), a few sentences at a time over
// `threads` threads (0: as many as there are). Throws Interrupted.
std::vector<NodeMarks> find_suspects(const EachStoredSentence& each, const Layout& layout,
                                     double rate_hz, int threads, const Progress& progress);

} // namespace phonomime
