// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime::demo {

// Parameters of the speaking mouth, all in mm from the closed mouth at rest.
enum Articulator {
  jaw,         // drop of the chin along its arc
  aperture,    // vertical distance of the inner lips in the middle
  width,       // each corner's way outwards; negative: rounded
  protrusion,  // of the lips, forwards
  upper_raise, // of the upper lip, beyond its share of the aperture
  tuck,        // of the lower lip, backwards under the upper teeth
  articulator_count
};
using Articulators = std::array<double, articulator_count>;

// Contacts that speech cannot do without: they are met in full whatever the neighbours.
enum class Contact { none, lips, lip_and_teeth };

// Where a phoneme wants the mouth, and how much it insists (alpha of the dominance function).
struct ArticulatoryTarget {
  Articulators value{};
  double jaw_dominance = 1.0;
  double lip_dominance = 1.0;   // aperture, upper_raise, tuck
  double round_dominance = 1.0; // width, protrusion
};

struct PhonemeArticulation {
  std::string_view phoneme;
  Contact contact = Contact::none;
  bool vowel = false;
  std::vector<ArticulatoryTarget> targets; // one; two for a diphthong; evenly spaced in the phoneme
};

// Every phoneme that Festival's US English lexicon uses, silence (pau) included.
std::span<const PhonemeArticulation> articulations();

// Throws InputError with the nearest candidates where the phoneme is not in the table.
const PhonemeArticulation& articulation_of(std::string_view phoneme);

} // namespace phonomime::demo
