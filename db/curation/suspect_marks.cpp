// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/curation/suspect_marks.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

// A length of markers in mm, a difference of weights without a unit.
std::string length(double value, LayoutKind kind) {
  return kind == LayoutKind::markers ? fmt::format("{:.1f} mm", value)
                                     : fmt::format("{:.2f}", value);
}

std::string precise(double value, LayoutKind kind) {
  return kind == LayoutKind::markers ? fmt::format("{:.2f} mm", value)
                                     : fmt::format("{:.3f}", value);
}

std::string and_more(std::size_t others) {
  return others == 0 ? "" : fmt::format(" and {} more", others);
}

std::string name_of(const Layout& layout, int group) {
  return group < 0 ? "the whole face" : layout.groups[static_cast<std::size_t>(group)].name;
}

} // namespace

void add_mark(std::vector<SuspectMark>& marks, SuspectMark mark) {
  const auto same = std::ranges::find(marks, mark.reason, &SuspectMark::reason);
  if (same == marks.end()) {
    marks.push_back(std::move(mark));
    return;
  }
  if (mark.score > same->score) {
    std::swap(*same, mark);
  }
  for (std::string& group : mark.groups) {
    if (std::ranges::find(same->groups, group) == same->groups.end()) {
      same->groups.push_back(std::move(group));
    }
  }
}

SuspectMark frozen_mark(const StillRun& run, SuspectOrigin origin, const Layout& layout,
                        const RunPlace& place) {
  const double start_s = place.start_s + static_cast<double>(run.first_frame) / place.rate_hz;
  const std::string meanwhile = run.group < 0 ? ""
                                              : fmt::format(" while those around move by {}",
                                                            precise(run.others, layout.kind));
  const bool own = place.first_frame < 0;
  SuspectMark mark{
      .reason = std::string(suspect::kFrozen),
      .origin = origin,
      .score = run.score(place.rate_hz),
      .first_frame = own ? static_cast<std::int32_t>(run.first_frame) : place.first_frame,
      .frame_count = own ? static_cast<std::int32_t>(run.frame_count) : place.frame_count,
      .text = fmt::format("frozen: {}{} still from {:.2f} s for {:.2f} s{}",
                          name_of(layout, run.group), and_more(place.others), start_s,
                          static_cast<double>(run.frame_count) / place.rate_hz, meanwhile)};
  if (run.group >= 0) {
    mark.groups.push_back(name_of(layout, run.group));
  }
  return mark;
}

namespace mark_text {

std::string displaced(const DisplacedRun& run, const NeighbourModel& model, const Layout& layout,
                      double rate_hz, std::size_t others) {
  const std::string span =
      fmt::format("from {:.2f} s for {:.2f} s", static_cast<double>(run.first_frame) / rate_hz,
                  static_cast<double>(run.frame_count) / rate_hz);
  const std::string how_far = length(run.peak, layout.kind);
  if (run.reason == suspect::kSwapped) {
    return fmt::format("swapped: {} and {} stand in each other's place {}, {} from their own",
                       name_of(layout, run.group), name_of(layout, run.partner), span, how_far);
  }
  const std::string who = name_of(layout, run.group) + and_more(others);
  const std::string limits =
      fmt::format("usual {}, limit {}", precise(model.usual(run.group), layout.kind),
                  length(model.limit(run.group), layout.kind));
  if (run.reason == suspect::kNeighbours) {
    return fmt::format("neighbours: {} {} from where its neighbours put it, {} ({})", who, how_far,
                       span, limits);
  }
  return fmt::format("{}: {} {} away from where its neighbours put it, within {:.2f} s, {} ({})",
                     run.reason, who, how_far, run.change_s, span, limits);
}

std::string step(const ClusterVerdict& verdict, const NodeMeasures& node,
                 const std::string& phoneme, const Layout& layout, double rate_hz) {
  return fmt::format(
      "jump: {} moved {} in one frame at {:.2f} s (usual of {} nodes of {} {}, limit {})",
      name_of(layout, node.step_group), length(verdict.value, layout.kind),
      static_cast<double>(node.step_frame) / rate_hz, verdict.count, phoneme,
      precise(verdict.usual, layout.kind), length(verdict.most, layout.kind));
}

std::string pose(const PoseVerdict& verdict, const std::string& phoneme, LayoutKind kind) {
  return fmt::format(
      "pose: its {} frame is {} from the nearest boundary of {} nodes of {} (usual {}, limit {})",
      verdict.last ? "last" : "first", length(verdict.verdict.value, kind), verdict.verdict.count,
      phoneme, precise(verdict.verdict.usual, kind), length(verdict.verdict.most, kind));
}

std::string duration(const ClusterVerdict& verdict, const std::string& phoneme) {
  return fmt::format("duration: {} of {:.3g} s (usual of {} nodes {:.3g} s, limits {:.3g} s to "
                     "{:.3g} s)",
                     phoneme, verdict.value, verdict.count, verdict.usual, verdict.least,
                     verdict.most);
}

} // namespace mark_text

} // namespace phonomime
