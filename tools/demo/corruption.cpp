// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/corruption.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tools/demo/articulation.h"
#include "tools/demo/marker_layout.h"
#include "tools/demo/random.h"

namespace phonomime::demo {

namespace {

constexpr int kSentencesPerDropout = 14;
constexpr int kSentencesPerContamination = 18;
constexpr double kLeastFreeze_s = 0.12;
constexpr double kDrift_s = 0.6;

std::vector<int> markers_in(std::initializer_list<Region> regions) {
  const Layout layout = marker_layout();
  std::vector<int> markers;
  for (int i = 0; i < layout.group_count(); ++i) {
    const ChannelGroup& group = layout.groups[static_cast<std::size_t>(i)];
    const auto holds = [&](Region region) { return group.in(region); };
    if (std::any_of(regions.begin(), regions.end(), holds))
      markers.push_back(i);
  }
  return markers;
}

int pick(const std::vector<int>& candidates, Random& random) {
  return candidates[static_cast<std::size_t>(random.index(static_cast<int>(candidates.size())))];
}

// The `count` candidates nearest to `marker` at rest, itself first.
std::vector<int> neighbourhood(int marker, std::vector<int> candidates, std::size_t count,
                               const MarkerPose& rest) {
  std::stable_sort(candidates.begin(), candidates.end(), [&](int a, int b) {
    return (rest.row(a) - rest.row(marker)).squaredNorm() <
           (rest.row(b) - rest.row(marker)).squaredNorm();
  });
  candidates.resize(std::min(count, candidates.size()));
  return candidates;
}

Eigen::RowVector3d random_offset(double length_mm, Random& random) {
  Eigen::RowVector3d direction(random.normal(), random.normal(), random.normal());
  return length_mm * direction.normalized();
}

// One of the three longest vowels, or of the longest segments where there is no vowel.
Segment pick_node(std::vector<Segment> segments, Random& random) {
  const auto rank = [](const Segment& s) {
    return (articulation_of(s.phoneme).vowel ? 100.0 : 0.0) + s.end_s - s.start_s;
  };
  std::stable_sort(segments.begin(), segments.end(),
                   [&](const Segment& a, const Segment& b) { return rank(a) > rank(b); });
  return segments[static_cast<std::size_t>(
      random.index(static_cast<int>(std::min<std::size_t>(3, segments.size()))))];
}

PlantedFault make_dropout(const std::vector<Segment>& segments, bool brief, Random& random) {
  const std::vector<int> candidates =
      markers_in({Region::lips, Region::jaw, Region::cheeks, Region::brows});
  PlantedFault fault;
  for (int i = random.index(2); i >= 0; --i)
    fault.markers.push_back(pick(candidates, random));
  const double length_s = brief ? random.uniform(0.02, 0.095) : random.uniform(0.25, 0.5);
  fault.start_s = random.uniform(0.1, 0.7) * segments.back().end_s;
  fault.end_s = fault.start_s + length_s;
  return fault;
}

PlantedFault make_contamination(const std::vector<Segment>& segments, Fault kind,
                                const MarkerPose& rest, Random& random) {
  const std::vector<int> mouth = markers_in({Region::lips, Region::jaw});
  const Segment node = pick_node(segments, random);
  PlantedFault fault;
  fault.fault = kind;
  fault.start_s = node.start_s;
  fault.end_s = node.end_s;
  const int marker = pick(mouth, random);
  switch (kind) {
  case Fault::swap: {
    const std::vector<int> near = neighbourhood(marker, mouth, 9, rest);
    const auto far_enough = std::find_if(near.begin(), near.end(), [&](int other) {
      return (rest.row(other) - rest.row(marker)).norm() >= 5.0;
    });
    fault.markers = {marker, far_enough == near.end() ? near.back() : *far_enough};
    break;
  }
  case Fault::jump:
    fault.markers = {marker};
    fault.offset_mm = random_offset(random.uniform(5.0, 15.0), random);
    break;
  case Fault::freeze:
    fault.markers = neighbourhood(marker_index(17), mouth, 8, rest);
    fault.end_s = std::max(fault.end_s, fault.start_s + kLeastFreeze_s);
    break;
  case Fault::drift:
    fault.markers = {marker};
    fault.start_s = std::max(0.0, fault.end_s - kDrift_s);
    fault.offset_mm = random_offset(random.uniform(6.0, 10.0), random);
    break;
  case Fault::dropout:
    break;
  }
  return fault;
}

} // namespace

std::string_view fault_name(Fault fault) {
  constexpr std::string_view names[] = {"dropout", "swap", "jump", "freeze", "drift"};
  return names[static_cast<int>(fault)];
}

std::vector<std::vector<PlantedFault>> plan_faults(std::span<const std::vector<Segment>> sentences,
                                                   const MarkerPose& rest, std::uint64_t seed) {
  Random random(seed_for(seed, "faults"));
  const int count = static_cast<int>(sentences.size());
  std::vector<int> order(sentences.size());
  std::iota(order.begin(), order.end(), 0);
  for (int i = count - 1; i > 0; --i)
    std::swap(order[static_cast<std::size_t>(i)],
              order[static_cast<std::size_t>(random.index(i + 1))]);

  std::vector<std::vector<PlantedFault>> plan(sentences.size());
  std::size_t next = 0;
  constexpr Fault kinds[] = {Fault::swap, Fault::jump, Fault::freeze, Fault::drift};
  for (int i = 0; i < count / kSentencesPerContamination; ++i, ++next) {
    const auto sentence = static_cast<std::size_t>(order[next]);
    plan[sentence] = {make_contamination(sentences[sentence], kinds[i % 4], rest, random)};
  }
  for (int i = 0; i < count / kSentencesPerDropout; ++i, ++next) {
    const auto sentence = static_cast<std::size_t>(order[next]);
    plan[sentence] = {make_dropout(sentences[sentence], i % 3 != 2, random)};
  }
  return plan;
}

void plant(const PlantedFault& fault, double rate_hz, std::vector<MarkerPose>& frames) {
  const std::size_t first = static_cast<std::size_t>(std::ceil(fault.start_s * rate_hz));
  for (std::size_t k = first; k < frames.size() && static_cast<double>(k) / rate_hz < fault.end_s;
       ++k) {
    const double share =
        (static_cast<double>(k) / rate_hz - fault.start_s) / (fault.end_s - fault.start_s);
    if (fault.fault == Fault::swap) {
      const Eigen::RowVector3d kept = frames[k].row(fault.markers[0]);
      frames[k].row(fault.markers[0]) = frames[k].row(fault.markers[1]);
      frames[k].row(fault.markers[1]) = kept;
      continue;
    }
    for (const int marker : fault.markers) {
      if (fault.fault == Fault::dropout)
        frames[k].row(marker).setConstant(std::numeric_limits<double>::quiet_NaN());
      else if (fault.fault == Fault::freeze)
        frames[k].row(marker) = frames[first].row(marker);
      else
        frames[k].row(marker) += (fault.fault == Fault::drift ? share : 1.0) * fault.offset_mm;
    }
  }
}

} // namespace phonomime::demo
