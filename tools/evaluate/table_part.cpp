// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/table_part.h"

#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

namespace phonomime {

namespace {

using Diphone = std::pair<std::string_view, std::string_view>;
using Triphone = std::tuple<std::string_view, std::string_view, std::string_view>;

// Index of each old node among the kept ones.
std::vector<NodeIndex> new_places(const MotionTable& table, const std::vector<bool>& keep) {
  std::vector<NodeIndex> places;
  NodeIndex next = 0;
  for (const MotionNode& node : table.nodes) {
    places.push_back(keep[static_cast<std::size_t>(node.sentence)] ? next++ : kNoNode);
  }
  return places;
}

} // namespace

MotionTable part_of(const MotionTable& table, const std::vector<bool>& keep) {
  MotionTable part = table;
  part.sentences.clear();
  part.nodes.clear();
  std::vector<std::int32_t> sentence_place(table.sentences.size(), -1);
  for (std::size_t s = 0; s < table.sentences.size(); ++s) {
    if (keep[s]) {
      sentence_place[s] = static_cast<std::int32_t>(part.sentences.size());
      part.sentences.push_back(table.sentences[s]);
    }
  }
  const std::vector<NodeIndex> places = new_places(table, keep);
  const auto moved = [&](NodeIndex node) {
    return node == kNoNode ? kNoNode : places[static_cast<std::size_t>(node)];
  };
  std::int64_t end = 0;   // of the frames kept so far
  std::int64_t shift = 0; // from an old row of coefficients to the new one
  std::int32_t current = -1;
  for (const MotionNode& node : table.nodes) {
    if (!keep[static_cast<std::size_t>(node.sentence)]) {
      continue;
    }
    if (node.sentence != current) {
      current = node.sentence;
      shift = end - node.first_frame;
    }
    MotionNode kept = node;
    kept.sentence = sentence_place[static_cast<std::size_t>(node.sentence)];
    kept.predecessor = moved(node.predecessor);
    kept.successor = moved(node.successor);
    kept.first_frame += shift;
    part.nodes.push_back(kept);
    // With the silence between this node and the one before.
    const std::int64_t new_end = kept.first_frame + kept.frame_count;
    part.coefficients.middleRows(end, new_end - end) =
        table.coefficients.middleRows(end - shift, new_end - end);
    end = new_end;
  }
  part.coefficients.conservativeResize(end, Eigen::NoChange);
  return part;
}

void ContextCoverage::add(const ContextCoverage& other) {
  diphones += other.diphones;
  diphones_recorded += other.diphones_recorded;
  triphones += other.triphones;
  triphones_recorded += other.triphones_recorded;
}

ContextCoverage context_coverage(const MotionTable& table,
                                 std::span<const ImportedSentence> asked) {
  std::set<Diphone> diphones;
  std::set<Triphone> triphones;
  const auto name = [&](std::int32_t phoneme) -> std::string_view {
    return table.phonemes[static_cast<std::size_t>(phoneme)].name;
  };
  for (const MotionNode& node : table.nodes) {
    const std::string_view before = name(node.previous_phoneme);
    const std::string_view after = name(node.next_phoneme);
    diphones.emplace(before, name(node.phoneme));
    diphones.emplace(name(node.phoneme), after);
    triphones.emplace(before, name(node.phoneme), after);
  }
  ContextCoverage coverage;
  const auto ask = [&](std::string_view first, std::string_view second) {
    coverage.diphones += 1;
    coverage.diphones_recorded += diphones.contains({first, second});
  };
  for (const ImportedSentence& sentence : asked) {
    const std::vector<TimedPhoneme>& rows = sentence.rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].is_silence()) {
        continue;
      }
      const std::string_view before = i > 0 ? std::string_view(rows[i - 1].phoneme.name) : kSilence;
      const std::string_view after =
          i + 1 < rows.size() ? std::string_view(rows[i + 1].phoneme.name) : kSilence;
      const std::string_view phoneme = rows[i].phoneme.name;
      ask(before, phoneme);
      if (after == kSilence) {
        ask(phoneme, after);
      }
      coverage.triphones += 1;
      coverage.triphones_recorded += triphones.contains({before, phoneme, after});
    }
  }
  return coverage;
}

} // namespace phonomime
