// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/emotion_track.h"
#include "db/types/motion_table.h"
#include "db/types/node_constraint.h"
#include "db/types/phoneme_set.h"
#include "synth/pipeline/row_constraints.h"
#include "synth/search/search_types.h"

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// What the search is to solve for a transcript: one step for each row from the first to the last
// that takes a node. /pau/ at either end takes none (DESIGN 4), unless a `use` constraint puts one
// there.
struct TranscriptSteps {
  std::size_t first_row = 0; // of the transcript; rows first_row .. first_row + steps.size() - 1
  std::vector<SearchStep> steps;
  std::vector<bool> used;            // per step: a `use` constraint holds there
  std::vector<std::string> warnings; // what is met, but is probably not meant
};

// Into MotionTable::emotions. `where` names the place of the request. Throws InputError for an
// emotion that the table does not have. Its intensity is not looked at: that is the style's.
std::int32_t find_asked_emotion(const MotionTable& table, const EmotionModifier& asked,
                                std::string_view where);

// One row of a transcript as the search sees it. Throws InputError as find_asked_emotion does.
SearchStep make_search_step(const MotionTable& table, const Phoneme& phoneme,
                            const EmotionModifier& emotion, RowConstraint constraint);

// Tells once of each phoneme that the table does not have.
class UnrecordedPhonemes {
public:
  explicit UnrecordedPhonemes(const MotionTable& table) : table_(table) {}
  void warn_of(const Phoneme& phoneme, const SearchStep& step, std::vector<std::string>& warnings);

private:
  const MotionTable& table_;
  std::set<std::string> seen_;
};

// `emotions`: one for each row. Throws InputError (which names file and line) for an emotion that
// the database does not have, and a constraint that cannot be met: an unknown, ambiguous or pruned
// node, a row or time outside the transcript, `use` and `avoid` that leave nothing.
TranscriptSteps make_transcript_steps(const MotionTable& table,
                                      std::span<const TimedPhoneme> transcript,
                                      std::span<const EmotionModifier> emotions,
                                      std::span<const NodeConstraint> constraints);

} // namespace phonomime
