// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/style_stack.h"

#include "db/types/errors.h"

#include <algorithm>
#include <set>

#include <Eigen/QR>

namespace phonomime {

namespace {

constexpr const char* kWhere = "training data of styles";

void check(const StyleStack& stack) {
  if (stack.styles.size() < 2) {
    throw InputError({.where = kWhere,
                      .what = "a style model needs the same speech in several styles",
                      .expected = "at least 2",
                      .got = std::to_string(stack.styles.size())});
  }
  if (std::set<std::string>(stack.styles.begin(), stack.styles.end()).size() !=
      stack.styles.size()) {
    throw InputError({.where = kWhere, .what = "a style is named twice"});
  }
  const auto rows = static_cast<Eigen::Index>(stack.styles.size()) * stack.vector_size;
  if (stack.vector_size < 1 || stack.columns.rows() != rows) {
    throw InternalError({.where = kWhere,
                         .what = "the rows are not one vector a style",
                         .expected = std::to_string(rows),
                         .got = std::to_string(stack.columns.rows())});
  }
  if (stack.columns.cols() == 0) {
    throw InputError({.where = kWhere,
                      .what = "there is no speech that was recorded in every style",
                      .remedy = "Record the same sentences in each, or name fewer styles."});
  }
  if (!stack.columns.allFinite()) {
    throw InputError({.where = kWhere, .what = "a number is not finite"});
  }
  if (stack.columns.isZero(0.0)) {
    throw InputError({.where = kWhere, .what = "nothing moves: every number is 0"});
  }
}

// The L of [factor, columns].
Eigen::MatrixXd add_columns(const Eigen::MatrixXd& factor,
                            const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  const Eigen::Index rows = columns.rows(), count = factor.cols() + columns.cols();
  Eigen::MatrixXd transposed(count, rows);
  transposed.topRows(factor.cols()) = factor.transpose();
  transposed.bottomRows(columns.cols()) = columns.transpose();
  if (count <= rows) {
    return transposed.transpose();
  }
  Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(transposed);
  return qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>().toDenseMatrix().transpose();
}

} // namespace

StackSummary summarise(const StyleStack& stack) {
  check(stack);
  StackSummary summary{.styles = stack.styles,
                       .vector_size = stack.vector_size,
                       .content_count = static_cast<double>(stack.columns.cols()),
                       .factor = Eigen::MatrixXd(stack.columns.rows(), 0),
                       .mean = stack.columns.rowwise().mean()};
  const Eigen::Index block = 3 * stack.columns.rows();
  for (Eigen::Index first = 0; first < stack.columns.cols(); first += block) {
    const Eigen::Index count = std::min(block, stack.columns.cols() - first);
    summary.factor = add_columns(summary.factor, stack.columns.middleCols(first, count));
  }
  return summary;
}

StackSummary merge_summaries(std::span<const StackSummary* const> parts) {
  if (parts.empty()) {
    throw InternalError({.where = kWhere, .what = "there is no part to merge"});
  }
  StackSummary merged = *parts.front();
  merged.mean *= merged.content_count;
  for (const StackSummary* part : parts.subspan(1)) {
    if (part->styles != merged.styles || part->vector_size != merged.vector_size) {
      throw InternalError({.where = kWhere, .what = "parts of different shapes cannot be merged"});
    }
    merged.factor = add_columns(merged.factor, part->factor);
    merged.mean += part->content_count * part->mean;
    merged.content_count += part->content_count;
  }
  merged.mean /= merged.content_count;
  return merged;
}

} // namespace phonomime
