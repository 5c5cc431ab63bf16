// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/suspect_mark.h"

#include <cstdint>
#include <vector>

namespace phonomime {

// The marks of a stored node, as a judge hands them to the store.
struct NodeMarks {
  std::int64_t sentence_id = 0; // StoredSentence::id
  std::int32_t row = 0;
  std::vector<SuspectMark> marks;
};

} // namespace phonomime
