// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// One line of sentences.tsv. Paths as written, relative to the corpus folder.
struct SentenceRow {
  std::string id;
  std::string text;    // may be empty
  std::string speaker; // the default where the table leaves it out
  std::string emotion; // "neutral" where the table leaves it out
  std::string motion;
  std::string alignment;
  std::string audio;             // may be empty
  std::optional<double> start_s; // cuts the sentence out of longer files, on their clock
  std::optional<double> end_s;
  long line = 0; // of the table
};

inline constexpr std::string_view kNeutral = "neutral";

// The sentences of a table's text (corpora_schema/sentences.md); `where` names the file. Throws
// InputError, with the line: not UTF-8, an unknown, repeated or missing column, too many fields, an
// empty or ill-formed id, speaker or emotion, a time that is no number or runs backwards, a
// repeated (speaker, emotion, id), no sentence at all.
std::vector<SentenceRow> parse_sentence_table(std::string_view text, std::string_view where,
                                              std::string_view default_speaker);

// Throws InputError, with `where`, unless `name` can stand in a node's key: not empty, without `/`,
// `#`, white space and control characters. `what` says what it names: "id".
void check_key_part(std::string_view name, std::string_view what, std::string_view where);

} // namespace phonomime
