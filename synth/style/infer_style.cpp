// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/infer_style.h"

#include "db/types/errors.h"
#include "synth/style/content_solver.h"

#include <cmath>

#include <Eigen/QR>

namespace phonomime {

namespace {

void check(const SymmetricModel& model, const Eigen::Ref<const Eigen::MatrixXd>& y) {
  if (y.rows() != model.vector_size) {
    throw InputError({.where = "style model",
                      .what = "the frames have another size than those that it was trained on",
                      .expected = std::to_string(model.vector_size),
                      .got = std::to_string(y.rows())});
  }
  if (y.cols() == 0) {
    throw InputError({.where = "style model", .what = "there is no frame to find a style in"});
  }
  if (!y.allFinite()) {
    throw InputError({.where = "style model", .what = "a frame has a number that is not finite"});
  }
}

// T2.12 for all frames together: what each dimension of the style would show of the contents, one
// frame below the other, fitted to the frames.
Eigen::VectorXd fit_expression(const SymmetricModel& model,
                               const Eigen::Ref<const Eigen::MatrixXd>& y,
                               const Eigen::MatrixXd& contents) {
  Eigen::MatrixXd shown(y.size(), model.style_size());
  for (Eigen::Index i = 0; i < model.style_size(); ++i) {
    const Eigen::MatrixXd one =
        model.bases.middleRows(i * model.vector_size, model.vector_size) * contents;
    shown.col(i) = one.reshaped();
  }
  return shown.completeOrthogonalDecomposition().solve(Eigen::VectorXd(y.reshaped()));
}

} // namespace

InferredStyle infer_style(const SymmetricModel& model, const Eigen::Ref<const Eigen::MatrixXd>& y,
                          const InferOptions& options) {
  check(model, y);
  const double size = std::sqrt(static_cast<double>(y.size()));
  const double whole = y.norm() / size;
  InferredStyle found{.contents = model.mean_content.replicate(1, y.cols())};
  for (int iteration = 0; iteration < options.most_iterations && !found.converged; ++iteration) {
    found.expression = fit_expression(model, y, found.contents);
    const Eigen::MatrixXd basis = model.basis(found.expression);
    found.contents = ContentSolver(basis, model.mean_content).solve(y, options.ridge);
    found.convergence.push_back((y - basis * found.contents).norm() / size);
    if (iteration < options.hold_first) {
      found.contents.row(0).setConstant(model.mean_content[0]);
    } else if (iteration > options.hold_first) {
      const std::size_t count = found.convergence.size();
      found.converged =
          found.convergence[count - 2] - found.convergence[count - 1] <= options.tolerance * whole;
    }
  }
  // A style twice as long with contents half as long shows the same: the first content coefficient
  // (T: it stays within a range) says which is meant.
  const double first = found.contents.row(0).mean();
  if (first != 0.0 && model.mean_content[0] != 0.0) {
    const double scale = model.mean_content[0] / first;
    found.contents *= scale;
    found.expression /= scale;
  }
  return found;
}

Eigen::MatrixXd show(const SymmetricModel& model,
                     const Eigen::Ref<const Eigen::VectorXd>& expression,
                     const Eigen::Ref<const Eigen::MatrixXd>& contents) {
  return model.basis(expression) * contents;
}

Eigen::Index nearest_style(const SymmetricModel& model,
                           const Eigen::Ref<const Eigen::VectorXd>& expression) {
  Eigen::Index nearest = 0;
  (model.expressions.colwise() - expression).colwise().squaredNorm().minCoeff(&nearest);
  return nearest;
}

} // namespace phonomime
