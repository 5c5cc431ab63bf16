// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/infer_style.h"

#include "db/types/errors.h"

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

// T2.12 and T2.13 by their normal equations, whose sums over frames and over the rows of a vector
// are made once: an iteration then works on matrices of I and J.
class Alternation {
public:
  Alternation(const SymmetricModel& model, const Eigen::Ref<const Eigen::MatrixXd>& y) {
    for (Eigen::Index i = 0; i < model.style_size(); ++i) {
      const auto one = model.bases.middleRows(i * model.vector_size, model.vector_size);
      seen_.emplace_back(one.transpose() * y);
      for (Eigen::Index j = 0; j < model.style_size(); ++j) {
        squares_.emplace_back(one.transpose() *
                              model.bases.middleRows(j * model.vector_size, model.vector_size));
      }
    }
  }

  // T2.12 for all frames together; contents: J by #frames.
  Eigen::VectorXd expression(const Eigen::MatrixXd& contents) const {
    const std::size_t count = seen_.size();
    const Eigen::MatrixXd all = contents * contents.transpose();
    Eigen::MatrixXd normal(seen_.size(), seen_.size());
    Eigen::VectorXd right(seen_.size());
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      right[row] = seen_[i].cwiseProduct(contents).sum();
      for (std::size_t j = 0; j < count; ++j) {
        normal(row, static_cast<Eigen::Index>(j)) = squares_[i * count + j].cwiseProduct(all).sum();
      }
    }
    return normal.completeOrthogonalDecomposition().solve(right);
  }

  // T2.13, with the ridge and the mean content m of ContentSolver.
  Eigen::MatrixXd contents(const Eigen::VectorXd& expression, const Eigen::VectorXd& mean_content,
                           double ridge) const {
    const std::size_t count = seen_.size();
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(mean_content.size(), mean_content.size());
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(mean_content.size(), seen_.front().cols());
    for (std::size_t i = 0; i < count; ++i) {
      const double weight = expression[static_cast<Eigen::Index>(i)];
      right += weight * seen_[i];
      for (std::size_t j = 0; j < count; ++j) {
        normal += weight * expression[static_cast<Eigen::Index>(j)] * squares_[i * count + j];
      }
    }
    right.colwise() -= normal * mean_content;
    normal.diagonal().array() += ridge;
    return normal.completeOrthogonalDecomposition().solve(right).colwise() + mean_content;
  }

private:
  std::vector<Eigen::MatrixXd> squares_; // I I of J by J: W^i' W^j
  std::vector<Eigen::MatrixXd> seen_;    // I of J by #frames: W^i' y
};

} // namespace

InferredStyle infer_style(const SymmetricModel& model, const Eigen::Ref<const Eigen::MatrixXd>& y,
                          const InferOptions& options) {
  check(model, y);
  const double size = std::sqrt(static_cast<double>(y.size()));
  const double whole = y.norm() / size;
  const Alternation alternation(model, y);
  InferredStyle found{.contents = model.mean_content.replicate(1, y.cols())};
  for (int iteration = 0; iteration < options.most_iterations && !found.converged; ++iteration) {
    found.expression = alternation.expression(found.contents);
    found.contents = alternation.contents(found.expression, model.mean_content, options.ridge);
    found.convergence.push_back((y - model.basis(found.expression) * found.contents).norm() / size);
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
