// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// Sentences of one kind, and what a classifier that was fitted to training recordings took them
// for.
struct EmotionTrial {
  std::string id;                                                       // "default"
  std::string description;                                              // one clause for people
  std::map<std::string, std::map<std::string, std::int64_t>> taken_for; // asked for -> heard
  std::int64_t sentences = 0;
  std::int64_t recognised = 0;        // taken for what was asked for
  std::int64_t recognised_moving = 0; // the same of the classifier that looks at movement too
  std::optional<double> closures;     // mean over sentences of closure recall

  std::optional<double> share() const { return share(recognised); }
  std::optional<double> share_moving() const { return share(recognised_moving); }
  // The same where this emotion was asked for.
  std::optional<double> share_of(const std::string& emotion) const {
    const auto asked = taken_for.find(emotion);
    if (asked == taken_for.end()) {
      return std::nullopt;
    }
    std::int64_t all = 0, right = 0;
    for (const auto& [heard, count] : asked->second) {
      all += count;
      right += heard == emotion ? count : 0;
    }
    return static_cast<double>(right) / static_cast<double>(all);
  }

private:
  std::optional<double> share(std::int64_t count) const {
    return sentences > 0
               ? std::optional(static_cast<double>(count) / static_cast<double>(sentences))
               : std::nullopt;
  }
};

// Whether the emotion that is asked for is seen in the motion, and leaves closures as they are.
struct EmotionFindings {
  std::vector<EmotionTrial> trials; // the recordings first
  // Closure recall where another emotion was asked for than was recorded, less that where it was
  // not: mean over sentences and emotions, standard error, Wilcoxon's signed-rank test.
  std::int64_t closure_pairs = 0;
  std::optional<double> closure_change, closure_change_error;
  double closure_p = 1.0;
};

} // namespace phonomime
