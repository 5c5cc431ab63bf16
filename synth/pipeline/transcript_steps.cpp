// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/transcript_steps.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace phonomime {

namespace {

// What all constraints on one row ask for together.
struct RowConstraint {
  std::optional<std::vector<NodeIndex>> use; // sorted
  std::vector<NodeIndex> avoid;              // sorted
  std::string where;                         // of the last constraint that changed it
};

std::size_t constrained_row(const NodeConstraint& constraint,
                            std::span<const TimedPhoneme> transcript) {
  if (constraint.index) {
    const long index = *constraint.index;
    if (index < 0 || index >= static_cast<long>(transcript.size())) {
      throw InputError({.where = constraint.where,
                        .what = "the transcript has no such row",
                        .expected = fmt::format("0 to {}", transcript.size() - 1),
                        .got = fmt::format("{}", index)});
    }
    return static_cast<std::size_t>(index);
  }
  const double time = *constraint.time_s;
  for (std::size_t row = 0; row < transcript.size(); ++row) {
    if (transcript[row].start_s <= time && time < transcript[row].end_s) {
      return row;
    }
  }
  throw InputError({.where = constraint.where,
                    .what = "the time is outside the transcript",
                    .expected = fmt::format("{} to {} s", format_number(transcript.front().start_s),
                                            format_number(transcript.back().end_s)),
                    .got = format_number(time) + " s"});
}

void add_constraint(const NodeConstraint& constraint, std::vector<NodeIndex> nodes,
                    RowConstraint& row) {
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  row.where = constraint.where;
  std::vector<NodeIndex> joined;
  if (constraint.kind == ConstraintKind::avoid) {
    std::ranges::set_union(row.avoid, nodes, std::back_inserter(joined));
    row.avoid = std::move(joined);
  } else if (!row.use) {
    row.use = std::move(nodes);
  } else {
    std::ranges::set_intersection(*row.use, nodes, std::back_inserter(joined));
    row.use = std::move(joined);
  }
}

void check_can_be_met(const MotionTable& table, const RowConstraint& row, std::size_t index) {
  std::vector<NodeIndex> left;
  if (row.use) {
    std::ranges::set_difference(*row.use, row.avoid, std::back_inserter(left));
  }
  const bool met = row.use ? !left.empty() : row.avoid.size() < table.nodes.size();
  if (!met) {
    throw InputError({.where = row.where,
                      .what = fmt::format("the constraints on row {} contradict each other: no "
                                          "motion node is left",
                                          index),
                      .remedy = "`use` lines on one row intersect, and `avoid` takes from them."});
  }
}

void warn_of_other_phonemes(const MotionTable& table, const TimedPhoneme& asked,
                            const NodeConstraint& constraint, const std::vector<NodeIndex>& nodes,
                            std::vector<std::string>& warnings) {
  for (const NodeIndex node : nodes) {
    const std::string& phoneme =
        table
            .phonemes[static_cast<std::size_t>(table.nodes[static_cast<std::size_t>(node)].phoneme)]
            .name;
    if (!asked.is_silence() && phoneme != asked.phoneme.name) {
      warnings.push_back(fmt::format("{}: {} was recorded as /{}/, the transcript has /{}/ there",
                                     constraint.where, table.key(node), phoneme,
                                     asked.phoneme.name));
    }
  }
}

std::vector<RowConstraint> constraints_per_row(const MotionTable& table,
                                               std::span<const TimedPhoneme> transcript,
                                               std::span<const NodeConstraint> constraints,
                                               std::vector<std::string>& warnings) {
  std::vector<RowConstraint> rows(transcript.size());
  for (const NodeConstraint& constraint : constraints) {
    const std::size_t row = constrained_row(constraint, transcript);
    std::vector<NodeIndex> nodes;
    for (const std::string& key : constraint.keys) {
      nodes.push_back(table.find_node(key, constraint.where));
    }
    if (constraint.kind == ConstraintKind::use) {
      warn_of_other_phonemes(table, transcript[row], constraint, nodes, warnings);
    }
    add_constraint(constraint, std::move(nodes), rows[row]);
    check_can_be_met(table, rows[row], row);
  }
  return rows;
}

} // namespace

std::int32_t find_asked_emotion(const MotionTable& table, const EmotionModifier& asked,
                                std::string_view where) {
  const std::optional<std::int32_t> emotion = table.find_emotion(asked.emotion);
  if (!emotion) {
    throw InputError({.where = std::string(where),
                      .what = fmt::format("emotion {} is not in the database's recordings of {}",
                                          quoted(asked.emotion), table.speaker),
                      .expected = fmt::format("one of {}", fmt::join(table.emotions, ", ")),
                      .remedy = did_you_mean(asked.emotion, table.emotions)});
  }
  if (asked.intensity != 1.0) {
    throw InputError({.where = std::string(where),
                      .what = fmt::format("emotion {} is asked for at another intensity than as "
                                          "recorded",
                                          quoted(asked.emotion)),
                      .expected = "1",
                      .got = format_number(asked.intensity),
                      .remedy = "Intensities need the style model, which this version does not "
                                "have yet."});
  }
  return *emotion;
}

TranscriptSteps make_transcript_steps(const MotionTable& table,
                                      std::span<const TimedPhoneme> transcript,
                                      std::span<const EmotionModifier> emotions,
                                      std::span<const NodeConstraint> constraints) {
  TranscriptSteps result;
  if (transcript.empty()) {
    throw InputError({.what = "the transcript has no phonemes"});
  }
  std::vector<RowConstraint> rows =
      constraints_per_row(table, transcript, constraints, result.warnings);
  const auto takes_node = [&](std::size_t row) {
    return !transcript[row].is_silence() || rows[row].use.has_value();
  };
  std::size_t first = 0;
  std::size_t end = transcript.size();
  while (first < end && !takes_node(first)) {
    ++first;
  }
  while (end > first && !takes_node(end - 1)) {
    --end;
  }
  result.first_row = first;
  std::set<std::string> unrecorded;
  for (std::size_t row = first; row < end; ++row) {
    const Phoneme& phoneme = transcript[row].phoneme;
    SearchStep step;
    step.is_silence = transcript[row].is_silence();
    step.phoneme = table.find_phoneme(phoneme.name).value_or(-1);
    step.viseme = table.find_viseme(phoneme.viseme).value_or(-1);
    step.emotion = find_asked_emotion(table, emotions[row], "");
    const bool recorded = std::ranges::any_of(
        table.nodes, [&](const MotionNode& node) { return node.phoneme == step.phoneme; });
    if (!step.is_silence && !recorded && unrecorded.insert(phoneme.name).second) {
      result.warnings.push_back(fmt::format(
          "/{}/ was never recorded: a phoneme of its viseme, or another, stands in", phoneme.name));
    }
    result.used.push_back(rows[row].use.has_value());
    if (rows[row].use) {
      step.allowed = std::move(*rows[row].use);
    }
    step.avoided = std::move(rows[row].avoid);
    result.steps.push_back(std::move(step));
  }
  return result;
}

} // namespace phonomime
