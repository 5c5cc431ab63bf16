// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/alignment.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// How much of a phoneme is seen on the face (E Table IV), with its smoothing weight of E16.
enum class Visibility { high, intermediate, low };
inline double smoothing_weight(Visibility visibility) { // E Table IV
  return visibility == Visibility::high ? 2.0 : visibility == Visibility::low ? 0.5 : 1.0;
}

inline constexpr std::string_view kSilence = "pau";

// A phoneme as the database knows it.
struct Phoneme {
  std::string name;   // "aa"
  std::string viseme; // one of the 15 of E Table VI, named by its first phoneme, or a user's own
  Visibility visibility = Visibility::intermediate;
  bool operator==(const Phoneme&) const = default;
};

// The symbols of one alignment alphabet and the phonemes they stand for. Several symbols may stand
// for one phoneme ("AA0", "AA1" -> /aa/; every name of silence -> /pau/).
class PhonemeSet {
public:
  // The set of a JSON text (corpora_schema/phoneme_set.md). `where` names it in errors.
  // Throws InputError.
  static PhonemeSet parse(std::string_view json_text, std::string_view where);

  // A set that comes with the program: "festival_us", "arpabet" or "timit". Throws InputError with
  // the names there are.
  static PhonemeSet built_in(std::string_view name);
  static std::vector<std::string> built_in_names();

  const std::string& name() const { return name_; }

  // Phonemes, silence first, then in the order of the file.
  const std::vector<Phoneme>& phonemes() const { return phonemes_; }

  // Every symbol, in the order of the file.
  const std::vector<std::string>& symbols() const { return symbols_; }

  // Index into phonemes(), or -1 where the symbol is unknown. Silence is 0.
  int find(std::string_view symbol) const;

private:
  std::string name_;
  bool case_sensitive_ = false;
  bool stress_digits_ = false;
  std::vector<Phoneme> phonemes_;
  std::vector<std::string> symbols_;
  std::map<std::string, int, std::less<>> index_;
};

// A row of a transcript: one phoneme, half-open in time.
struct TimedPhoneme {
  Phoneme phoneme;
  double start_s = 0.0;
  double end_s = 0.0;
  bool is_silence() const { return phoneme.name == kSilence; }
};

// The alignment's rows as phonemes, with /pau/ wherever it leaves out time (before the first row,
// between rows; gaps under 1 microsecond are closed). Each row of the file stays one row, silence
// too, but silence of no duration, which is left out. Throws InputError for an unknown symbol
// (file, line, set and the nearest candidates) and for any other phoneme of no duration.
std::vector<TimedPhoneme> to_phonemes(const Alignment& alignment, const PhonemeSet& set);

} // namespace phonomime
