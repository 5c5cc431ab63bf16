// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/phoneme_set.h"

#include "db/types/text.h"
#include "tests/support/expect_error.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace phonomime {
namespace {

using test::input_error;

std::vector<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

// E Table VI, copied from the paper row by row (/yl/ read /y/).
const std::vector<std::string> kTable6 = {"pau",
                                          "ae ax ah aa",
                                          "ao y iy ih ay aw",
                                          "ey eh el em en er",
                                          "b p m",
                                          "r",
                                          "f v",
                                          "ow oy",
                                          "th dh",
                                          "hh",
                                          "k g ng",
                                          "ch sh jh",
                                          "n d t l",
                                          "s z zh",
                                          "w uw uh"};

std::map<std::string, std::string> table6() {
  std::map<std::string, std::string> viseme_of;
  for (const std::string& row : kTable6) {
    for (const std::string& phoneme : words(row)) {
      viseme_of[phoneme] = words(row).front();
    }
  }
  return viseme_of;
}

const Phoneme& phoneme_of(const PhonemeSet& set, const std::string& symbol) {
  const int index = set.find(symbol);
  EXPECT_GE(index, 0) << set.name() << " lacks " << symbol;
  return set.phonemes().at(static_cast<std::size_t>(std::max(index, 0)));
}

TEST(PhonemeSet, VisemesAreThoseOfTable6) {
  ASSERT_EQ(kTable6.size(), 15u);
  const std::map<std::string, std::string> viseme_of = table6();
  std::set<std::string> seen;
  for (const std::string& name : PhonemeSet::built_in_names()) {
    std::set<std::string> names;
    const PhonemeSet set = PhonemeSet::built_in(name);
    for (const Phoneme& phoneme : set.phonemes()) {
      ASSERT_TRUE(viseme_of.contains(phoneme.name)) << name << ": " << phoneme.name;
      EXPECT_EQ(phoneme.viseme, viseme_of.at(phoneme.name)) << name << ": " << phoneme.name;
      EXPECT_TRUE(names.insert(phoneme.name).second) << name << ": " << phoneme.name;
      seen.insert(phoneme.name);
    }
    EXPECT_EQ(names.size(), viseme_of.size()) << name << " lacks a phoneme of the table";
  }
  EXPECT_EQ(seen.size(), viseme_of.size());
}

TEST(PhonemeSet, VisibilityIsThatOfTable4) {
  const std::vector<std::string> high = words("p b m f v w");
  const std::vector<std::string> low = words("k g ch ng r");
  for (const std::string& name : PhonemeSet::built_in_names()) {
    const PhonemeSet set = PhonemeSet::built_in(name);
    for (const Phoneme& phoneme : set.phonemes()) {
      const bool is_high = std::ranges::find(high, phoneme.name) != high.end();
      const bool is_low = std::ranges::find(low, phoneme.name) != low.end();
      EXPECT_EQ(smoothing_weight(phoneme.visibility), is_high  ? 2.0
                                                      : is_low ? 0.5
                                                               : 1.0)
          << name << ": " << phoneme.name;
    }
  }
}

TEST(PhonemeSet, SilenceComesFirstUnderAllItsNames) {
  EXPECT_EQ(PhonemeSet::built_in_names(),
            (std::vector<std::string>{"arpabet", "festival_us", "timit"}));
  for (const std::string& name : PhonemeSet::built_in_names()) {
    const PhonemeSet set = PhonemeSet::built_in(name);
    EXPECT_EQ(set.name(), name);
    EXPECT_EQ(set.phonemes().front().name, kSilence);
    for (const char* symbol : {"pau", "sil", "sp", "SIL", "spn", "", "h#", "<s>", "</s>", "#"}) {
      EXPECT_EQ(set.find(symbol), 0) << name << ": " << symbol;
    }
  }
  EXPECT_EQ(PhonemeSet::built_in("festival_us").find("brth"), 0);
  EXPECT_EQ(PhonemeSet::built_in("timit").find("epi"), 0);
}

TEST(PhonemeSet, FestivalHasEveryPhoneOfTheRadioSet) {
  const PhonemeSet set = PhonemeSet::built_in("festival_us");
  for (const std::string& symbol : words(
           "aa ae ah ao aw ax axr ay b ch d dh dx eh el em en er ey f g hh hv ih iy jh k l m n nx "
           "ng ow oy p r s sh t th uh uw v w y z zh")) {
    EXPECT_GT(set.find(symbol), 0) << symbol;
  }
  EXPECT_EQ(phoneme_of(set, "dx").name, "n");
  EXPECT_EQ(phoneme_of(set, "nx").name, "n");
  EXPECT_EQ(phoneme_of(set, "hv").name, "hh");
  EXPECT_EQ(phoneme_of(set, "axr").name, "er");
  EXPECT_LT(set.find("aa1"), 0) << "Festival writes no stress digits";

  // Against Festival itself, where it is installed.
  std::ifstream scheme("/usr/share/festival/radio_phones.scm");
  const std::regex row(R"(\s*\(([a-z#]+)\s+[-+](\s+[-+\w]+){7}\).*)");
  int found = 0;
  for (std::string line; std::getline(scheme, line);) {
    std::smatch match;
    if (std::regex_match(line, match, row)) {
      ++found;
      EXPECT_GE(set.find(match[1].str()), 0) << match[1];
    }
  }
  EXPECT_TRUE(!std::filesystem::exists("/usr/share/festival/radio_phones.scm") || found >= 46)
      << found;
}

TEST(PhonemeSet, ArpabetTakesStressDigitsInAnyCase) {
  const PhonemeSet set = PhonemeSet::built_in("arpabet");
  for (const std::string& symbol : words(
           "AA AE AH AO AW AY B CH D DH EH ER EY F G HH IH IY JH K L M N NG OW OY P R S SH T TH UH "
           "UW V W Y Z ZH")) {
    EXPECT_EQ(phoneme_of(set, symbol).name, to_lower(symbol));
    EXPECT_EQ(set.find(to_lower(symbol)), set.find(symbol));
  }
  for (const std::string& vowel : words("AA AE AH AO AW AY EH ER EY IH IY OW OY UH UW")) {
    for (const char* stress : {"0", "1", "2"}) {
      EXPECT_EQ(set.find(vowel + stress), set.find(vowel)) << vowel << stress;
    }
    EXPECT_LT(set.find(vowel + "3"), 0) << vowel;
    EXPECT_LT(set.find(vowel + "11"), 0) << vowel;
  }
  for (const char* symbol : {"sil1", "0", "1", "pau2", "+", "axx"}) {
    EXPECT_LT(set.find(symbol), 0) << symbol;
  }
}

TEST(PhonemeSet, TimitHasItsSixtyOnePhones) {
  const PhonemeSet set = PhonemeSet::built_in("timit");
  const std::vector<std::string> phones = words(
      "aa ae ah ao aw ax ax-h axr ay b bcl ch d dcl dh dx eh el em en eng epi er ey f g gcl h# "
      "hh hv ih ix iy jh k kcl l m n ng nx ow oy p pau pcl q r s sh t tcl th uh uw ux v w y z "
      "zh");
  ASSERT_EQ(phones.size(), 61u);
  for (const std::string& phone : phones) {
    EXPECT_GE(set.find(phone), 0) << phone;
  }
  for (const char* stop : {"b", "d", "g", "k", "p", "t"}) {
    EXPECT_EQ(set.find(std::string(stop) + "cl"), set.find(stop)) << stop;
  }
  EXPECT_EQ(phoneme_of(set, "ix").name, "ih");
  EXPECT_EQ(phoneme_of(set, "ux").name, "uw");
  EXPECT_EQ(phoneme_of(set, "eng").name, "ng");
}

TEST(PhonemeSet, SetsAgreeOnThePhonemesTheyShare) {
  std::map<std::string, Phoneme> known;
  for (const std::string& name : PhonemeSet::built_in_names()) {
    const PhonemeSet set = PhonemeSet::built_in(name);
    for (const Phoneme& phoneme : set.phonemes()) {
      EXPECT_EQ(known.emplace(phoneme.name, phoneme).first->second, phoneme) << name;
    }
  }
  EXPECT_NE(input_error([] { PhonemeSet::built_in("arpabt"); }).find("Did you mean \"arpabet\"?"),
            std::string::npos);
}

nlohmann::json small_set() {
  return nlohmann::json::parse(R"({"format": "phonomime-phoneme-set", "version": 1, "name": "small",
    "case_sensitive": true, "silence": ["_", ""], "phonemes": [
    {"phoneme": "aa", "symbols": ["a", "A"], "viseme": "wide", "visibility": "high"},
    {"phoneme": "eh", "symbols": ["E"], "viseme": "half", "visibility": "low"}]})");
}

std::string set_error(const nlohmann::json& set) {
  return input_error([&] { PhonemeSet::parse(set.dump(), "set.json"); });
}

TEST(PhonemeSet, AUsersOwnIsAFile) {
  const PhonemeSet set = PhonemeSet::parse(small_set().dump(), "set.json");
  EXPECT_EQ(set.symbols(), (std::vector<std::string>{"_", "", "a", "A", "E"}));
  EXPECT_EQ(set.find("A"), 1);
  EXPECT_EQ(set.find("E"), 2);
  EXPECT_EQ(set.find("e"), -1) << "the set minds case";
  EXPECT_EQ(set.find("a1"), -1) << "the set has no stress digits";
  EXPECT_EQ(set.find(""), 0);
  EXPECT_EQ(set.phonemes()[2], (Phoneme{"eh", "half", Visibility::low}));

  nlohmann::json wrong = small_set();
  wrong["phonemes"][1]["symbols"] = {"a"};
  EXPECT_NE(set_error(wrong).find("symbol \"a\" stands there twice"), std::string::npos);
  wrong = small_set();
  wrong["case_sensitive"] = false;
  EXPECT_NE(set_error(wrong).find("the set ignores case"), std::string::npos);
  wrong = small_set();
  wrong["phonemes"][1]["phoneme"] = "aa";
  EXPECT_NE(set_error(wrong).find("phoneme \"aa\" stands there twice"), std::string::npos);
  wrong["phonemes"][1]["phoneme"] = "pau";
  EXPECT_NE(set_error(wrong).find("Silence is given by \"silence\" alone"), std::string::npos);
  wrong = small_set();
  wrong["phonemes"][0]["symbols"] = {"a b"};
  EXPECT_NE(set_error(wrong).find("white space"), std::string::npos);
  wrong = small_set();
  wrong["phonemes"][0]["visibility"] = "some";
  EXPECT_NE(set_error(wrong).find("$.phonemes[0].visibility has an unknown value"),
            std::string::npos);
}

Alignment alignment(std::vector<AlignedLabel> rows) {
  long line = 4;
  for (AlignedLabel& row : rows) {
    row.line = ++line;
  }
  return {.source = "u17.lab", .rows = std::move(rows)};
}

TEST(ToPhonemes, TimeLeftOutIsSilence) {
  const PhonemeSet set = PhonemeSet::built_in("arpabet");
  const std::vector<TimedPhoneme> phonemes = to_phonemes(alignment({{"B", 0.25, 0.5},
                                                                    {"AH0", 0.5, 0.75},
                                                                    {"sp", 0.75, 1.0},
                                                                    {"sil", 1.0, 1.25},
                                                                    {"T", 1.5, 1.75},
                                                                    {"S", 1.7500005, 2.0}}),
                                                         set);
  const std::vector<std::string> names = {"pau", "b", "ah", "pau", "pau", "pau", "t", "s"};
  ASSERT_EQ(phonemes.size(), names.size());
  EXPECT_EQ(phonemes.front().start_s, 0.0);
  EXPECT_EQ(phonemes.back().end_s, 2.0);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(phonemes[i].phoneme.name, names[i]) << i;
    EXPECT_EQ(phonemes[i].is_silence(), names[i] == "pau") << i;
    if (i > 0) {
      EXPECT_EQ(phonemes[i].start_s, phonemes[i - 1].end_s) << i;
    }
  }
  EXPECT_EQ(phonemes[5].start_s, 1.25);
  EXPECT_EQ(phonemes[5].end_s, 1.5);
}

TEST(ToPhonemes, GapsUnderAMicrosecondAreClosed) {
  const PhonemeSet set = PhonemeSet::built_in("arpabet");
  EXPECT_EQ(to_phonemes(alignment({{"b", 0.0, 0.5}, {"t", 0.5000009, 1.0}}), set).size(), 2u);
  EXPECT_EQ(to_phonemes(alignment({{"b", 0.0, 0.5}, {"t", 0.5000011, 1.0}}), set).size(), 3u);
  EXPECT_EQ(to_phonemes(alignment({{"b", 9e-7, 0.5}}), set).front().start_s, 0.0);
}

TEST(ToPhonemes, AnUnknownSymbolNamesThePlaceAndTheNearest) {
  const PhonemeSet set = PhonemeSet::built_in("festival_us");
  EXPECT_EQ(input_error([&] {
              to_phonemes(alignment({{"pau", 0.0, 0.1}, {"axx", 0.1, 0.2}}), set);
            }).find("u17.lab:6: phoneme \"axx\" is not in set festival_us. Did you mean \"ax\""),
            0u);
  EXPECT_EQ(input_error([&] {
              to_phonemes(alignment({{"\xC3\x98", 0.0, 0.1}}), set);
            }),
            "u17.lab:5: phoneme \"\xC3\x98\" is not in set festival_us");
}

TEST(ToPhonemes, SilenceOfNoDurationIsLeftOutAndNothingElseIs) {
  const PhonemeSet set = PhonemeSet::built_in("festival_us");
  const std::vector<TimedPhoneme> phonemes =
      to_phonemes(alignment({{"b", 0.0, 0.2}, {"pau", 0.2, 0.5}, {"pau", 0.5, 0.5}}), set);
  ASSERT_EQ(phonemes.size(), 2u);
  EXPECT_EQ(phonemes[1].end_s, 0.5);
  EXPECT_NE(input_error([&] {
              to_phonemes(alignment({{"pau", 0.0, 0.1}, {"b", 0.1, 0.1}}), set);
            }).find("u17.lab:6: phoneme \"b\" has no duration"),
            std::string::npos);
}

TEST(ToPhonemes, TimesThatRunBackwardsAreRefused) {
  const PhonemeSet set = PhonemeSet::built_in("arpabet");
  EXPECT_THROW(to_phonemes(alignment({{"b", 0.0, 0.2}, {"t", 0.1, 0.3}}), set), InputError);
  EXPECT_THROW(to_phonemes(alignment({{"b", 0.2, 0.1}}), set), InputError);
  EXPECT_THROW(to_phonemes(alignment({{"b", std::nan(""), 0.1}}), set), InputError);
}

} // namespace
} // namespace phonomime
