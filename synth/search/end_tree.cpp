// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/end_tree.h"

#include "synth/search/vector_dispatch.h"
#include "synth/search/vector_lanes.h"

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

// City-block distances of eight points from one, feature f in sum f mod 4.
PHONOMIME_DISPATCHED
void distances_to_points(const float* point, const float* points, float* distances) {
  FloatLanes sums[4] = {};
  for (std::size_t f = 0; f < kFeatureCount; f += 4) {
    for (std::size_t s = 0; s < 4; ++s) {
      FloatLanes other;
      load(other, points + (f + s) * kFloatLanes);
      FloatLanes difference = other - point[f + s];
      make_absolute(difference);
      sums[s] += difference;
    }
  }
  const FloatLanes total = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  std::memcpy(distances, &total, sizeof total);
}

// The same to the nearest points of eight boxes.
PHONOMIME_DISPATCHED
void distances_to_boxes(const float* point, const float* low, const float* high, float* distances) {
  FloatLanes sums[4] = {};
  for (std::size_t f = 0; f < kFeatureCount; f += 4) {
    for (std::size_t s = 0; s < 4; ++s) {
      FloatLanes from, to;
      load(from, low + (f + s) * kFloatLanes);
      load(to, high + (f + s) * kFloatLanes);
      const float x = point[f + s];
      for (std::size_t lane = 0; lane < kFloatLanes; ++lane) {
        from[lane] = std::max(from[lane] - x, 0.0f);
        to[lane] = std::max(x - to[lane], 0.0f);
      }
      sums[s] += from + to;
    }
  }
  const FloatLanes total = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  std::memcpy(distances, &total, sizeof total);
}

// Bounds from distances: value + what the distance says for certain + `other_viseme` where neither
// `viseme` nor a mixture is meant, less the rounding of these sums.
PHONOMIME_DISPATCHED
void bounds_from_distances(const float* distances, const float* value, const std::int32_t* visemes,
                           std::int32_t viseme, float other_viseme, float margin, float* bounds) {
  constexpr float kCertain = 1.0f - 1e-5f;
  constexpr float kBelow = 1.0f - 4e-7f;
  for (std::size_t lane = 0; lane < kFloatLanes; ++lane) {
    const bool same = visemes[lane] == viseme || visemes[lane] == kMixed;
    const float join = std::max(distances[lane] * kCertain - margin, 0.0f);
    bounds[lane] = (value[lane] + (join + (same ? 0.0f : other_viseme))) * kBelow;
  }
}

} // namespace

EndTree::EndTree(const JoinSketch& sketch, const MotionTable& table, NodeEnd which,
                 std::span<const Entry> entries)
    : sketch_(&sketch) {
  if (entries.empty()) {
    return;
  }
  levels_.push_back(points(table, which, entries));
  while (levels_.back().value.size() > kFan) {
    levels_.push_back(boxes(levels_.back(), levels_.size() == 1));
  }
}

EndTree::Level EndTree::points(const MotionTable& table, NodeEnd which,
                               std::span<const Entry> entries) const {
  const std::size_t groups = (entries.size() + kFan - 1) / kFan;
  Level level;
  level.low.resize(groups * kFeatures * kFan);
  level.value.assign(groups * kFan, std::numeric_limits<float>::infinity());
  level.viseme.assign(groups * kFan, kMixed);
  for (std::size_t i = 0; i < groups * kFan; ++i) {
    const Entry& entry =
        entries[std::min(i, entries.size() - 1)]; // the last group repeats the last
    const float* end = sketch_->end(which, entry.node);
    float* place = level.low.data() + i / kFan * kFeatures * kFan + i % kFan;
    for (std::size_t f = 0; f < kFeatures; ++f) {
      place[f * kFan] = end[f];
    }
    level.viseme[i] = join_viseme(table, which, entry.node);
    if (i < entries.size()) {
      level.value[i] = float_below(entry.value);
    }
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
  level.value.assign(groups * kFan, std::numeric_limits<float>::infinity());
  level.viseme.assign(groups * kFan, kMixed);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = i / kFan * kFeatures * kFan + i % kFan;
    for (std::size_t f = 0; f < kFeatures; ++f) {
      const std::size_t from = (i * kFeatures + f) * kFan;
      level.low[place + f * kFan] = *std::min_element(&below.low[from], &below.low[from] + kFan);
      level.high[place + f * kFan] = *std::max_element(&below_high[from], &below_high[from] + kFan);
    }
    const auto children = std::span(below.viseme).subspan(i * kFan, kFan);
    level.value[i] = *std::min_element(&below.value[i * kFan], &below.value[i * kFan] + kFan);
    level.viseme[i] =
        std::ranges::all_of(children, [&](std::int32_t v) { return v == children[0]; })
            ? children[0]
            : kMixed;
  }
  return level;
}

void EndTree::bound_children(const Query& query, std::size_t level, std::size_t group,
                             std::array<float, kFan>& bounds) const {
  const Level& own = levels_[level];
  const std::size_t place = group * kFeatures * kFan;
  std::array<float, kFan> distances;
  if (level == 0) {
    distances_to_points(query.end, &own.low[place], distances.data());
  } else {
    distances_to_boxes(query.end, &own.low[place], &own.high[place], distances.data());
  }
  bounds_from_distances(distances.data(), &own.value[group * kFan], &own.viseme[group * kFan],
                        query.viseme, query.other_viseme, query.margin, bounds.data());
}

} // namespace phonomime
