// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/geodesics.h"

#include "db/types/parallel_for.h"
#include "isomap/paths_in_lanes.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace phonomime {

namespace {

constexpr std::size_t kGroupsAtOnce = 8;    // a thread's share
constexpr std::size_t kGroupsAReport = 128; // between looks at Progress
constexpr std::size_t kReach = 128;         // points about a source; others among them are near it
constexpr std::size_t kFewest = 4;          // sources that are worth going side by side

// Sources that are near each other: where they stand in `sources`.
using Group = std::vector<std::int32_t>;

// The sources in groups of at most PathsInLanes::kLanes, by numbers of edges; those that have too
// few others near them stay alone.
std::vector<Group> group_sources(const NeighbourGraph& graph,
                                 std::span<const std::int32_t> sources) {
  const auto point_count = static_cast<std::size_t>(graph.point_count());
  std::vector<std::int32_t> source_at(point_count, -1), seen_by(point_count, -1);
  std::vector<Group> groups;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    std::int32_t& place = source_at[static_cast<std::size_t>(sources[i])];
    if (place >= 0) {
      groups.push_back({place}); // the same point once more
    }
    place = static_cast<std::int32_t>(i);
  }
  std::vector<std::int32_t> near;
  for (const std::int32_t source : sources) {
    if (source_at[static_cast<std::size_t>(source)] < 0) {
      continue;
    }
    Group group;
    near.assign(1, source);
    seen_by[static_cast<std::size_t>(source)] = source;
    for (std::size_t n = 0;
         n < std::min(near.size(), kReach) && group.size() < PathsInLanes::kLanes; ++n) {
      const std::int32_t point = near[n];
      if (source_at[static_cast<std::size_t>(point)] >= 0) {
        group.push_back(source_at[static_cast<std::size_t>(point)]);
      }
      for (const NeighbourGraph::Edge& edge : graph.edges_of(point)) {
        if (seen_by[static_cast<std::size_t>(edge.target)] != source) {
          seen_by[static_cast<std::size_t>(edge.target)] = source;
          near.push_back(edge.target);
        }
      }
    }
    if (group.size() < kFewest) {
      group.resize(1);
    }
    for (const std::int32_t member : group) {
      source_at[static_cast<std::size_t>(sources[static_cast<std::size_t>(member)])] = -1;
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

// Paths from one group after the other.
class GroupedPaths {
public:
  explicit GroupedPaths(const NeighbourGraph& graph) : graph_(graph) {}

  void run(const Group& group, std::span<const std::int32_t> sources, DistanceMatrix& distances) {
    std::vector<std::int32_t> members;
    std::vector<double*> rows;
    for (const std::int32_t member : group) {
      members.push_back(sources[static_cast<std::size_t>(member)]);
      rows.push_back(distances.row(member).data());
    }
    if (group.size() > 1) {
      made(in_lanes_).run(members, rows);
    } else {
      made(alone_).run(members, rows.front());
    }
  }

private:
  template <typename Paths>
  Paths& made(std::optional<Paths>& paths) {
    return paths ? *paths : paths.emplace(graph_);
  }

  const NeighbourGraph& graph_;
  std::optional<ShortestPaths> alone_;
  std::optional<PathsInLanes> in_lanes_;
};

} // namespace

DistanceMatrix geodesic_distances(const NeighbourGraph& graph,
                                  std::span<const std::int32_t> sources, int threads,
                                  const Progress& progress) {
  const auto source_count = static_cast<std::ptrdiff_t>(sources.size());
  DistanceMatrix distances(source_count, graph.point_count());
  const std::vector<Group> groups = group_sources(graph, sources);
  std::ptrdiff_t done = 0;
  for (std::size_t begin = 0; begin < groups.size(); begin += kGroupsAReport) {
    progress.update("geodesics", done, source_count);
    const auto some =
        std::span(groups).subspan(begin, std::min(kGroupsAReport, groups.size() - begin));
    const std::size_t shares = (some.size() + kGroupsAtOnce - 1) / kGroupsAtOnce;
    parallel_for(static_cast<std::ptrdiff_t>(shares), threads, [&](std::ptrdiff_t share) {
      GroupedPaths paths(graph);
      const std::size_t first = static_cast<std::size_t>(share) * kGroupsAtOnce;
      for (std::size_t g = first; g < std::min(first + kGroupsAtOnce, some.size()); ++g) {
        paths.run(some[g], sources, distances);
      }
    });
    for (const Group& group : some) {
      done += static_cast<std::ptrdiff_t>(group.size());
    }
  }
  progress.update("geodesics", source_count, source_count);
  return distances;
}

} // namespace phonomime
