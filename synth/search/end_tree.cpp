// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/end_tree.h"

#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace phonomime {

namespace {

constexpr std::size_t kFeatureCount = JoinSketch::kFeatures;
constexpr std::int32_t kMixed = -2;

inline void make_absolute(FloatLanes& lanes) {
  for (std::size_t lane = 0; lane < kFloatLanes; ++lane) {
    lanes[lane] = std::fabs(lanes[lane]);
  }
}

using MaskLanes = std::int32_t __attribute__((vector_size(kFloatLanes * sizeof(std::int32_t))));
using HalfMask = std::int32_t __attribute__((vector_size(kFloatLanes / 2 * sizeof(std::int32_t))));

// What a query asks of eight children, beside their places.
struct ChildQuery {
  const float* point;
  std::int32_t viseme;
  float other_viseme;
  float margin;
  float most; // bounds above need not be tight
};

// Bounds from city-block distances: value + what the distance says for certain + `other_viseme`
// where neither `viseme` nor a mixture is meant, less the rounding of these sums.
[[gnu::always_inline]] inline void
bounds_from_distances(const FloatLanes& distances, const ChildQuery& query, const float* value,
                      const std::int32_t* visemes, FloatLanes& bounds) {
  constexpr float kCertain = 1.0f - 1e-5f;
  constexpr float kBelow = 1.0f - 4e-7f;
  FloatLanes values;
  load(values, value);
  MaskLanes classes;
  std::memcpy(&classes, visemes, sizeof classes);
  const FloatLanes nothing = {};
  const FloatLanes certain = distances * kCertain - query.margin;
  const FloatLanes join = certain > nothing ? certain : nothing;
  const MaskLanes same = (classes == query.viseme) | (classes == kMixed);
  bounds = (values + (join + (same ? nothing : nothing + query.other_viseme))) * kBelow;
}

// Bit i for bounds[i] <= most.
[[gnu::always_inline]] inline unsigned bits_within(const FloatLanes& bounds, float most) {
  constexpr MaskLanes kBits = {1, 2, 4, 8, 16, 32, 64, 128};
  const MaskLanes bits = (bounds <= most) & kBits;
  HalfMask halves[2];
  std::memcpy(halves, &bits, sizeof bits);
  const HalfMask both = halves[0] | halves[1];
  return static_cast<unsigned>((both[0] | both[1]) | (both[2] | both[3]));
}

// Adds up add_feature(f, sum) over the features, f in sum f mod 4; where half of them leave no
// child within query.most, the other half is not looked at. Returns which children are within, by
// bits.
template <typename AddFeature>
[[gnu::always_inline]] inline unsigned bound_eight(const ChildQuery& query, const float* value,
                                                   const std::int32_t* visemes, float* bounds,
                                                   const AddFeature& add_feature) {
  FloatLanes sums[4] = {};
  FloatLanes found;
  unsigned within = 0;
  for (std::size_t half = 0; half < 2; ++half) {
    const std::size_t begin = half * kFeatureCount / 2;
    for (std::size_t f = begin; f < begin + kFeatureCount / 2; f += 4) {
      for (std::size_t s = 0; s < 4; ++s) {
        add_feature(f + s, sums[s]);
      }
    }
    const FloatLanes total = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    bounds_from_distances(total, query, value, visemes, found);
    within = bits_within(found, query.most);
    if (within == 0) {
      return within;
    }
  }
  std::memcpy(bounds, &found, sizeof found);
  return within;
}

PHONOMIME_DISPATCHED
unsigned bound_points(const ChildQuery& query, const float* points, const float* value,
                      const std::int32_t* visemes, float* bounds) {
  return bound_eight(query, value, visemes, bounds, [&](std::size_t f, FloatLanes& sum) {
    FloatLanes other;
    load(other, points + f * kFloatLanes);
    FloatLanes difference = other - query.point[f];
    make_absolute(difference);
    sum += difference;
  });
}

// The same to the nearest points of boxes.
PHONOMIME_DISPATCHED
unsigned bound_boxes(const ChildQuery& query, const float* low, const float* high,
                     const float* value, const std::int32_t* visemes, float* bounds) {
  return bound_eight(query, value, visemes, bounds, [&](std::size_t f, FloatLanes& sum) {
    FloatLanes from, to;
    load(from, low + f * kFloatLanes);
    load(to, high + f * kFloatLanes);
    const float x = query.point[f];
    for (std::size_t lane = 0; lane < kFloatLanes; ++lane) {
      from[lane] = std::max(from[lane], x);
      to[lane] = std::min(to[lane], x);
    }
    sum += from - to; // at least one of the two is x
  });
}

} // namespace

EndTree::EndTree(const JoinSketch& sketch, const MotionTable& table, NodeEnd which,
                 std::span<const NodeIndex> entries)
    : sketch_(&sketch) {
  if (entries.empty()) {
    return;
  }
  levels_.push_back(points(table, which, entries));
  while (levels_.back().value.size() > kFan) {
    levels_.push_back(boxes(levels_.back(), levels_.size() == 1));
  }
}

void EndTree::set_values(std::span<const double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    levels_[0].value[i] = float_below(values[i]);
  }
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    const std::vector<float>& below = levels_[level - 1].value;
    for (std::size_t i = 0; i < below.size() / kFan; ++i) {
      levels_[level].value[i] = *std::min_element(&below[i * kFan], &below[i * kFan] + kFan);
    }
  }
}

EndTree::Level EndTree::points(const MotionTable& table, NodeEnd which,
                               std::span<const NodeIndex> entries) const {
  const std::size_t groups = (entries.size() + kFan - 1) / kFan;
  Level level;
  level.low.resize(groups * kFeatures * kFan);
  level.value.assign(groups * kFan, kNothing);
  level.viseme.assign(groups * kFan, kMixed);
  for (std::size_t i = 0; i < groups * kFan; ++i) {
    // The last group repeats the last.
    const NodeIndex node = entries[std::min(i, entries.size() - 1)];
    const float* end = sketch_->end(which, node);
    float* place = level.low.data() + i / kFan * kFeatures * kFan + i % kFan;
    for (std::size_t f = 0; f < kFeatures; ++f) {
      place[f * kFan] = end[f];
    }
    level.viseme[i] = join_viseme(table, which, node);
  }
  return level;
}

EndTree::Level EndTree::boxes(const Level& below, bool below_is_points) {
  const std::vector<float>& below_high = below_is_points ? below.low : below.high;
  const std::size_t count = below.value.size() / kFan;
  const std::size_t groups = (count + kFan - 1) / kFan;
  Level level;
  level.low.resize(groups * kFeatures * kFan);
  level.high.resize(groups * kFeatures * kFan);
  level.value.assign(groups * kFan, kNothing);
  level.viseme.assign(groups * kFan, kMixed);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = i / kFan * kFeatures * kFan + i % kFan;
    for (std::size_t f = 0; f < kFeatures; ++f) {
      const std::size_t from = (i * kFeatures + f) * kFan;
      level.low[place + f * kFan] = *std::min_element(&below.low[from], &below.low[from] + kFan);
      level.high[place + f * kFan] = *std::max_element(&below_high[from], &below_high[from] + kFan);
    }
    const auto children = std::span(below.viseme).subspan(i * kFan, kFan);
    level.viseme[i] =
        std::ranges::all_of(children, [&](std::int32_t v) { return v == children[0]; })
            ? children[0]
            : kMixed;
  }
  return level;
}

unsigned EndTree::bound_children(const Query& query, double most, std::size_t level,
                                 std::size_t group, std::array<float, kFan>& bounds) const {
  const Level& own = levels_[level];
  const std::size_t place = group * kFeatures * kFan;
  // A float that is at most a number is at most the nearest float of it.
  const ChildQuery asked{query.end, query.viseme, query.other_viseme, query.margin,
                         static_cast<float>(most)};
  const float* value = &own.value[group * kFan];
  const std::int32_t* visemes = &own.viseme[group * kFan];
  if (level == 0) {
    return bound_points(asked, &own.low[place], value, visemes, bounds.data());
  }
  return bound_boxes(asked, &own.low[place], &own.high[place], value, visemes, bounds.data());
}

} // namespace phonomime
