// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/row_constraints.h"

#include "db/types/errors.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

void join(const NodeConstraint& constraint, std::vector<NodeIndex> nodes, RowConstraint& row) {
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
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

void check_can_be_met(const MotionTable& table, const RowConstraint& row,
                      const NodeConstraint& last, std::size_t index) {
  std::vector<NodeIndex> left;
  if (row.use) {
    std::ranges::set_difference(*row.use, row.avoid, std::back_inserter(left));
  }
  const bool met = row.use ? !left.empty() : row.avoid.size() < table.nodes.size();
  if (!met) {
    throw InputError({.where = last.where,
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

} // namespace

void add_constraint(const MotionTable& table, const NodeConstraint& constraint, std::size_t index,
                    const TimedPhoneme& asked, RowConstraint& row,
                    std::vector<std::string>& warnings) {
  std::vector<NodeIndex> nodes;
  for (const std::string& key : constraint.keys) {
    nodes.push_back(table.find_node(key, constraint.where));
  }
  if (constraint.kind == ConstraintKind::use) {
    warn_of_other_phonemes(table, asked, constraint, nodes, warnings);
  }
  join(constraint, std::move(nodes), row);
  check_can_be_met(table, row, constraint, index);
}

} // namespace phonomime
