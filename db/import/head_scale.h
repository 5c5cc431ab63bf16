// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/head.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace phonomime {

// The sizes of a speaker's head (point_spread of the anchor) over many frames.
class HeadSizes {
public:
  // Of the frames (#frames by #channels, mm) that show the whole anchor.
  void add(const FrameMatrixD& frames, const HeadAnchor& anchor);
  void add(const HeadSizes& other);

  std::int64_t count() const { return count_; }
  // Sum of the squared deviations of the logarithms from their mean.
  double squared_deviations() const;

private:
  std::int64_t count_ = 0;
  double sum_ = 0.0; // of logarithms
  double sum_of_squares_ = 0.0;
};

// Who says what the scale of a corpus is, the first that says anything being believed.
struct ScaleSayings {
  std::optional<Scale> asked;    // by the person who imports
  std::optional<Scale> layout;   // by layout.json
  std::optional<Scale> database; // by what went in before
};

struct FoundScale {
  Scale scale = Scale::measured;
  std::string origin;          // "asked for", "layout", "database", "found"
  double size_variation = 0.0; // relative standard deviation over the frames of each speaker
};

// Where nobody says, the scale is nominal if sizes vary by more than 1 %. `where` names the corpus.
// Throws InputError where it is nominal and the anchor cannot tell a size.
FoundScale choose_scale(const ScaleSayings& sayings, const std::map<std::string, HeadSizes>& sizes,
                        const HeadAnchor& anchor, const std::string& where);

} // namespace phonomime
