// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/articulation.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "tools/demo/segments.h"

namespace phonomime::demo {

namespace {

using Target = ArticulatoryTarget;

// {jaw, aperture, width, protrusion, upper_raise, tuck}, then the three dominances.
// Vowels hold the jaw; labials hold the lips; sounds of the tongue let the lips go with their
// neighbours.
std::vector<PhonemeArticulation> make_table() {
  const Contact none = Contact::none;
  std::vector<PhonemeArticulation> table;
  const auto vowel = [&](std::string_view phoneme, std::vector<Target> targets) {
    table.push_back({phoneme, none, true, std::move(targets)});
  };
  const auto consonant = [&](std::string_view phoneme, Target target) {
    table.push_back({phoneme, none, false, {target}});
  };
  const auto contact = [&](std::string_view phoneme, Contact kind, Target target) {
    table.push_back({phoneme, kind, false, {target}});
  };

  consonant(kSilence, {{0, 0, 0, 0, 0, 0}, 1.0, 1.0, 1.0});

  vowel("aa", {{{14, 14, -1, 0, 0, 0}, 1.2, 1.0, 0.8}});
  vowel("ae", {{{12, 12, 3, 0, 0.5, 0}, 1.1, 1.0, 0.9}});
  vowel("ah", {{{8.5, 8.5, 0, 0, 0, 0}, 1.0, 1.0, 0.6}});
  vowel("ao", {{{10.5, 10, -4.5, 3.5, 0, 0}, 1.1, 1.0, 1.1}});
  vowel("aw", {{{13, 13, 0, 0, 0, 0}, 1.1, 1.0, 0.8}, {{5, 5, -6, 4.5, 0, 0}, 0.9, 0.9, 1.0}});
  vowel("ax", {{{5, 5.5, 0, 0, 0, 0}, 0.6, 0.6, 0.4}});
  vowel("ay", {{{13, 13, 0, 0, 0, 0}, 1.1, 1.0, 0.8}, {{5, 6, 3.5, 0, 0, 0}, 0.9, 0.9, 0.9}});
  vowel("eh", {{{8.5, 9, 2.5, 0, 0.3, 0}, 1.0, 1.0, 0.8}});
  vowel("er", {{{5, 6, -4, 3, 0, 0}, 0.9, 0.9, 1.0}});
  vowel("ey", {{{7, 8, 3, 0, 0.3, 0}, 1.0, 1.0, 0.9}, {{4, 5.5, 4, 0, 0, 0}, 0.9, 0.9, 0.9}});
  vowel("ih", {{{5, 6, 2.5, 0, 0, 0}, 0.8, 0.8, 0.7}});
  vowel("iy", {{{3, 5, 5.5, -0.5, 0.3, 0}, 1.0, 1.0, 1.2}});
  vowel("ow", {{{8, 8, -4.5, 3.5, 0, 0}, 1.0, 1.0, 1.1}, {{4, 4, -7, 5.5, 0, 0}, 0.9, 1.0, 1.2}});
  vowel("oy", {{{8.5, 8, -5, 4, 0, 0}, 1.0, 1.0, 1.1}, {{4.5, 6, 3, 0, 0, 0}, 0.9, 0.9, 0.9}});
  vowel("uh", {{{5, 5.5, -4, 3, 0, 0}, 0.8, 0.9, 0.9}});
  vowel("uw", {{{3, 3.2, -7.5, 6, 0, 0}, 1.0, 1.2, 1.5}});

  contact("b", Contact::lips, {{2, 0, 0, 0, 0, 0}, 0.8, 3.0, 0.15});
  contact("m", Contact::lips, {{2, 0, 0, 0, 0, 0}, 0.8, 3.0, 0.15});
  contact("p", Contact::lips, {{2, 0, 0, 0, 0, 0}, 0.8, 3.0, 0.15});
  contact("f", Contact::lip_and_teeth, {{2.5, 2.6, 0.5, 0, 1.8, 4.5}, 1.0, 2.5, 0.3});
  contact("v", Contact::lip_and_teeth, {{2.5, 2.6, 0.5, 0, 1.8, 4.5}, 1.0, 2.5, 0.3});

  consonant("ch", {{2, 5.5, -4, 5, 1.0, 0}, 1.4, 1.0, 1.1});
  consonant("jh", {{2, 5.5, -4, 5, 1.0, 0}, 1.4, 1.0, 1.1});
  consonant("sh", {{2, 5.5, -4, 5, 1.0, 0}, 1.4, 1.0, 1.2});
  consonant("zh", {{2, 5.5, -4, 5, 1.0, 0}, 1.4, 1.0, 1.2});
  consonant("s", {{1.5, 4.2, 2.5, 0, 0.3, 0}, 1.6, 0.9, 0.5});
  consonant("z", {{1.5, 4.2, 2.5, 0, 0.3, 0}, 1.6, 0.9, 0.5});
  consonant("d", {{3.5, 4.8, 1, 0, 0, 0}, 0.9, 0.5, 0.25});
  consonant("t", {{3, 4.6, 1, 0, 0, 0}, 1.0, 0.5, 0.25});
  consonant("n", {{3.5, 4.8, 1, 0, 0, 0}, 0.8, 0.5, 0.25});
  consonant("l", {{5.5, 6.5, 0.5, 0, 0, 0}, 0.7, 0.6, 0.3});
  consonant("dh", {{3.5, 5, 0.5, 0, 0.5, 0}, 1.0, 0.7, 0.35});
  consonant("th", {{3.5, 5, 0.5, 0, 0.5, 0}, 1.1, 0.8, 0.4});
  consonant("g", {{4.5, 5.2, 0.5, 0, 0, 0}, 0.5, 0.4, 0.2});
  consonant("k", {{4.5, 5.2, 0.5, 0, 0, 0}, 0.5, 0.4, 0.2});
  consonant("ng", {{4.5, 5.2, 0.5, 0, 0, 0}, 0.5, 0.4, 0.2});
  consonant("hh", {{5.5, 6, 0, 0, 0, 0}, 0.25, 0.25, 0.15});
  consonant("r", {{4, 4.5, -4, 3.5, 0, 0}, 0.8, 0.8, 0.9});
  consonant("w", {{2.5, 2.2, -8, 6.5, 0, 0}, 0.9, 1.5, 1.8});
  consonant("y", {{3, 4.8, 4, 0, 0, 0}, 0.9, 0.7, 0.9});
  return table;
}

} // namespace

std::span<const PhonemeArticulation> articulations() {
  static const std::vector<PhonemeArticulation> table = make_table();
  return table;
}

const PhonemeArticulation& articulation_of(std::string_view phoneme) {
  std::vector<std::string> names;
  for (const PhonemeArticulation& entry : articulations()) {
    if (entry.phoneme == phoneme)
      return entry;
    names.emplace_back(entry.phoneme);
  }
  throw InputError({.what = "phoneme " + quoted(phoneme) + " has no articulation",
                    .expected = "a phoneme of Festival's US English",
                    .remedy = did_you_mean(phoneme, names)});
}

} // namespace phonomime::demo
