// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace phonomime {

// The same speech in several styles: Y of T2.6 and S6. Column t holds one content in every style,
// one style below the other: rows s K to (s + 1) K - 1 are the vector of style s.
struct StyleStack {
  std::vector<std::string> styles; // S
  Eigen::Index vector_size = 0;    // K
  Eigen::MatrixXd columns;         // S K by #contents, not centred
};

// All that the fits need of a stack. A fit does not see the order of the columns, nor any rotation
// of them: Y = L Q' with orthonormal columns in Q has the singular values and the left singular
// vectors of L, and every sum of squares over the columns is the same for both. L has no more
// columns than rows, however long the recordings are.
struct StackSummary {
  std::vector<std::string> styles; // S
  Eigen::Index vector_size = 0;    // K
  double content_count = 0;        // T, columns of Y
  Eigen::MatrixXd factor;          // L: S K by at most S K
  Eigen::VectorXd mean;            // S K: the mean column of Y

  Eigen::Index style_count() const { return static_cast<Eigen::Index>(styles.size()); }
  auto style_rows(Eigen::Index style) const {
    return factor.middleRows(style * vector_size, vector_size);
  }
  auto style_mean(Eigen::Index style) const {
    return mean.segment(style * vector_size, vector_size);
  }
};

// L by Householder reflections, a block of columns after the other. Throws InputError: fewer than
// two styles, a style named twice, no columns, a number that is not finite, nothing but zeros;
// InternalError where the rows are not S K.
StackSummary summarise(const StyleStack& stack);

// The summary of several stacks' columns together. Throws InternalError where their styles or
// vector sizes differ, or there is none.
StackSummary merge_summaries(std::span<const StackSummary* const> parts);

} // namespace phonomime
