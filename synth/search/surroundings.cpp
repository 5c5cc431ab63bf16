// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/surroundings.h"

#include <algorithm>

namespace phonomime {

namespace {

// The phoneme that is said at a time, starting to look at i.
std::int32_t said_at(std::span<const SpokenPhoneme> utterance, std::size_t i, double time_s) {
  while (i > 0 && time_s < utterance[i].start_s) {
    --i;
  }
  while (i + 1 < utterance.size() && time_s >= utterance[i].end_s) {
    ++i;
  }
  const bool inside = utterance[i].start_s <= time_s && time_s < utterance[i].end_s;
  return inside ? utterance[i].phoneme : 0;
}

bool adjoin(const SpokenPhoneme& a, const SpokenPhoneme& b, double hole_s) {
  return b.start_s - a.end_s < hole_s;
}

} // namespace

Surroundings surroundings_of(std::span<const SpokenPhoneme> utterance, std::size_t i,
                             double hole_s) {
  const SpokenPhoneme& own = utterance[i];
  Surroundings found;
  for (std::size_t j = 0; j < Surroundings::kLooks; ++j) {
    const double away_s =
        Surroundings::kFirstLook_s + static_cast<double>(j) * Surroundings::kLookStep_s;
    found.before[j] = said_at(utterance, i, own.start_s - away_s);
    found.after[j] = said_at(utterance, i, own.end_s + away_s);
  }
  std::size_t first = i;
  while (first > 0 && adjoin(utterance[first - 1], utterance[first], hole_s)) {
    --first;
  }
  std::size_t last = i;
  while (last + 1 < utterance.size() && adjoin(utterance[last], utterance[last + 1], hole_s)) {
    ++last;
  }
  const auto neighbour = [&](std::size_t steps, bool later) {
    const std::size_t room = later ? last - i : i - first;
    return steps > room ? 0 : utterance[later ? i + steps : i - steps].phoneme;
  };
  found.previous = neighbour(1, false);
  found.second_previous = neighbour(2, false);
  found.next = neighbour(1, true);
  found.second_next = neighbour(2, true);
  found.duration_s = own.end_s - own.start_s;
  const double phrase_s = utterance[last].end_s - utterance[first].start_s;
  if (phrase_s > 0.0) {
    found.position = (0.5 * (own.start_s + own.end_s) - utterance[first].start_s) / phrase_s;
  }
  return found;
}

std::vector<Surroundings> recorded_surroundings(const MotionTable& table) {
  std::vector<std::size_t> begins; // of the sentences, in table.nodes
  for (std::size_t i = 0; i < table.nodes.size(); ++i) {
    if (i == 0 || table.nodes[i].sentence != table.nodes[i - 1].sentence) {
      begins.push_back(i);
    }
  }
  const std::size_t sentences = begins.size();
  begins.push_back(table.nodes.size());
  std::vector<Surroundings> surroundings(table.nodes.size());
  const double frame_s = 1.0 / table.rate_hz;
#pragma omp parallel for schedule(static)
  for (std::size_t s = 0; s < sentences; ++s) {
    std::vector<SpokenPhoneme> utterance;
    for (std::size_t i = begins[s]; i < begins[s + 1]; ++i) {
      const MotionNode& node = table.nodes[i];
      utterance.push_back({static_cast<double>(node.first_frame) * frame_s,
                           static_cast<double>(node.first_frame + node.frame_count) * frame_s,
                           node.phoneme});
    }
    for (std::size_t i = begins[s]; i < begins[s + 1]; ++i) {
      surroundings[i] = surroundings_of(utterance, i - begins[s], 0.5 * frame_s);
      surroundings[i].duration_s = table.nodes[i].frame_count / table.rate_hz; // to the bit
    }
  }
  return surroundings;
}

} // namespace phonomime
