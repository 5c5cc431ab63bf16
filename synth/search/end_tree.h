// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/join_sketch.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace phonomime {

// The nearest float that is not above a number, and not below one.
inline float float_below(double number) {
  const auto nearest = static_cast<float>(number);
  return static_cast<double>(nearest) <= number
             ? nearest
             : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}
inline float float_above(double number) {
  return -float_below(-number);
}

// Ends of motion nodes, its entries, with the cost of all that lies behind each, in a tree of
// boxes, eight children a box: finds those whose cost + join may be within a limit, nearest first,
// at a fraction of a look at all of them.
class EndTree {
public:
  EndTree() = default;
  // Of these nodes, its entries, in the order of JoinSketch::order(which). All values are infinite.
  EndTree(const JoinSketch& sketch, const MotionTable& table, NodeEnd which,
          std::span<const NodeIndex> entries);

  // One an entry. Those of an infinite value are never within a limit.
  void set_values(std::span<const double> values);

  // Calls visit(entry index, its join viseme, its bound) for every entry whose bound is within
  // limit(), in an order that lowers the limit soon; limit() may fall from call to call. The bound
  // is never above value + gaps (E7) of the join with `end`, + `other_viseme` where the entry's
  // join viseme is not `viseme`. Returns how many bounds it has computed.
  template <typename Limit, typename Visit>
  std::int64_t search(const float* end, std::int32_t viseme, double other_viseme,
                      const Limit& limit, const Visit& visit) const {
    if (levels_.empty()) {
      return 0;
    }
    const Query query{end, viseme, float_below(other_viseme), float_above(sketch_->margin())};
    return descend(query, levels_.size() - 1, 0, limit, visit);
  }

private:
  static constexpr std::size_t kFan = 8;
  static constexpr std::size_t kFeatures = JoinSketch::kFeatures;
  static constexpr float kNothing = std::numeric_limits<float>::infinity();

  struct Query {
    const float* end;
    std::int32_t viseme;
    float other_viseme;
    float margin;
  };
  // Eight boxes (points at the lowest level, where `high` is not kept), feature by feature.
  struct Level {
    std::vector<float> low, high;     // per group: kFeatures by kFan
    std::vector<float> value;         // at most the least one inside; infinite where there is none
    std::vector<std::int32_t> viseme; // -2 where they differ inside
  };

  Level points(const MotionTable& table, NodeEnd which, std::span<const NodeIndex> entries) const;
  static Level boxes(const Level& below, bool below_is_points);
  // Returns by bits which of the eight children of a group may be within `most`; where there is
  // any, with the bounds of all of them.
  unsigned bound_children(const Query& query, double most, std::size_t level, std::size_t group,
                          std::array<float, kFan>& bounds) const;

  template <typename Limit, typename Visit>
  std::int64_t descend(const Query& query, std::size_t level, std::size_t group, const Limit& limit,
                       const Visit& visit) const {
    std::array<float, kFan> bounds;
    std::array<std::size_t, kFan> nearest; // of those within the limit
    std::size_t count = 0;
    for (unsigned left = bound_children(query, limit(), level, group, bounds); left != 0;
         left &= left - 1) {
      const auto child = static_cast<std::size_t>(std::countr_zero(left));
      std::size_t place = count++;
      for (; place > 0 && bounds[nearest[place - 1]] > bounds[child]; --place) {
        nearest[place] = nearest[place - 1];
      }
      nearest[place] = child;
    }
    std::int64_t computed = kFan;
    for (std::size_t i = 0; i < count; ++i) {
      const float bound = bounds[nearest[i]];
      if (bound == kNothing || static_cast<double>(bound) > limit()) {
        break;
      }
      const std::size_t place = group * kFan + nearest[i];
      if (level == 0) {
        visit(place, levels_[0].viseme[place], static_cast<double>(bound));
      } else {
        computed += descend(query, level - 1, place, limit, visit);
      }
    }
    return computed;
  }

  const JoinSketch* sketch_ = nullptr;
  std::vector<Level> levels_; // [0] points
};

} // namespace phonomime
