// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <limits>
#include <vector>

namespace phonomime {

// A point and how far it is. Nearer comes first, ties by index: a total order.
struct Candidate {
  double distance_sq = 0.0;
  std::int32_t index = 0;
  auto operator<=>(const Candidate&) const = default;
};

// The `count` first of all candidates that it was offered, in order.
class NearestList {
public:
  explicit NearestList(int count) : count_(static_cast<std::size_t>(count)) {
    candidates_.reserve(count_ + 1);
  }

  void offer(const Candidate& candidate) {
    if (candidates_.size() == count_ && !(candidate < candidates_.back())) {
      return;
    }
    candidates_.insert(std::upper_bound(candidates_.begin(), candidates_.end(), candidate),
                       candidate);
    if (candidates_.size() > count_) {
      candidates_.pop_back();
    }
  }

  // Candidates farther than this do not enter.
  double reach_sq() const {
    return candidates_.size() < count_ ? std::numeric_limits<double>::infinity()
                                       : candidates_.back().distance_sq;
  }
  const std::vector<Candidate>& candidates() const { return candidates_; }

private:
  std::size_t count_;
  std::vector<Candidate> candidates_;
};

} // namespace phonomime
