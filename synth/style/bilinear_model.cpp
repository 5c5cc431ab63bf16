// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/bilinear_model.h"

#include "db/types/errors.h"
#include "synth/style/singular_vectors.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

namespace {

void check_size(const char* what, Eigen::Index size, Eigen::Index most) {
  if (size < 1 || size > most) {
    throw InputError({.where = "style model",
                      .what = std::string("the number of ") + what + " dimensions is out of range",
                      .expected = "1 to " + std::to_string(most),
                      .got = std::to_string(size)});
  }
}

double root_mean_square(const Eigen::MatrixXd& residual, const StackSummary& data) {
  return residual.norm() / std::sqrt(data.content_count * static_cast<double>(residual.rows()));
}

// The first J right singular vectors, as orthonormal rows: J by #columns.
Eigen::MatrixXd leading_rows(const Eigen::MatrixXd& matrix, Eigen::Index count) {
  return singular_vectors(matrix).right.leftCols(count).transpose();
}

} // namespace

AsymmetricModel fit_asymmetric(const StackSummary& data, Eigen::Index content_size) {
  check_size("content", content_size, data.factor.cols());
  const SingularVectors found = singular_vectors(data.factor);
  const double scale = std::sqrt(data.content_count);
  AsymmetricModel model{.styles = data.styles, .vector_size = data.vector_size};
  model.spectrum = found.values / scale;
  const auto left = found.left.leftCols(content_size);
  const auto values = model.spectrum.head(content_size);
  model.bases = left * values.asDiagonal();
  // The mean of V' sqrt(T); a direction in which the data have no extent has no content either.
  model.mean_content =
      (left.transpose() * data.mean).cwiseProduct(values.unaryExpr([](double value) {
        return value > 0.0 ? 1.0 / value : 0.0;
      }));
  model.residual = root_mean_square(data.factor - left * (left.transpose() * data.factor), data);
  return model;
}

Eigen::MatrixXd vector_transpose(const Eigen::Ref<const Eigen::MatrixXd>& matrix,
                                 Eigen::Index block) {
  const Eigen::Index blocks = matrix.rows() / block;
  Eigen::MatrixXd transposed(matrix.cols() * block, blocks);
  for (Eigen::Index i = 0; i < blocks; ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      transposed.block(j * block, i, block, 1) = matrix.block(i * block, j, block, 1);
    }
  }
  return transposed;
}

Eigen::MatrixXd SymmetricModel::basis(const Eigen::Ref<const Eigen::VectorXd>& expression) const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(vector_size, bases.cols());
  for (Eigen::Index i = 0; i < style_size(); ++i) {
    sum += expression[i] * bases.middleRows(i * vector_size, vector_size);
  }
  return sum;
}

SymmetricModel fit_symmetric(const StackSummary& data, const SymmetricOptions& options) {
  const Eigen::Index size = data.vector_size;
  check_size("style", options.style_size, data.style_count());
  check_size("content", options.content_size,
             std::min(data.factor.cols(), options.style_size * size));
  const Eigen::MatrixXd& y = data.factor;
  const double whole = root_mean_square(y, data);
  // Y with its styles in the columns: S columns, so that products with E are plain.
  const Eigen::MatrixXd by_style = vector_transpose(y, size);

  Eigen::MatrixXd contents = leading_rows(y, options.content_size); // J by #columns
  Eigen::MatrixXd styles, bases;
  SymmetricModel model{.styles = data.styles, .vector_size = size};
  for (int iteration = 0; iteration < options.most_iterations && !model.converged; ++iteration) {
    styles = leading_rows(vector_transpose(y * contents.transpose(), size), options.style_size);
    const Eigen::MatrixXd by_content =
        vector_transpose(by_style * styles.transpose(), size); // I K by #columns
    contents = leading_rows(by_content, options.content_size);
    bases = by_content * contents.transpose(); // S11
    const Eigen::MatrixXd shown =
        vector_transpose(vector_transpose(bases, size) * styles, size) * contents;
    model.convergence.push_back(root_mean_square(y - shown, data));
    const std::size_t count = model.convergence.size();
    // Where every style has a dimension of its own, the second pass would find what the first did.
    model.converged = options.style_size == data.style_count() ||
                      (count > 1 && model.convergence[count - 2] - model.convergence[count - 1] <=
                                        options.tolerance * whole);
  }
  const double scale = std::sqrt(data.content_count);
  model.expressions = styles;
  model.bases = bases / scale;
  // The mean content, by least squares in what the model shows of the mean: with orthonormal rows
  // in E and C, the columns of W are orthogonal, their squared lengths the squared singular values.
  const Eigen::VectorXd mean =
      vector_transpose(vector_transpose(data.mean, size) * styles.transpose(), size);
  const Eigen::VectorXd squares = model.bases.colwise().squaredNorm();
  model.mean_content =
      (model.bases.transpose() * mean).cwiseProduct(squares.unaryExpr([](double square) {
        return square > 0.0 ? 1.0 / square : 0.0;
      }));
  return model;
}

} // namespace phonomime
