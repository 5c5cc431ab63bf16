// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/style/style_stack.h"

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace phonomime::test {

// Numbers in [-1, 1], the same on every machine.
class MadeNumbers {
public:
  explicit MadeNumbers(std::uint64_t seed) : state_(seed) {}
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) * 0x1p-52 - 1.0;
  }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd made(rows, columns);
    for (double& value : made.reshaped()) {
      value = next();
    }
    return made;
  }

private:
  std::uint64_t state_;
};

// A true bilinear model (S4), number by number: y_k = sum over i and j of e_i W_k(i, j) c_j.
struct TrueModel {
  Eigen::Index vector_size = 0;   // K
  std::vector<Eigen::MatrixXd> w; // K of I by J
  Eigen::MatrixXd expressions;    // I by S

  TrueModel(Eigen::Index size, Eigen::Index style_size, Eigen::Index content_size,
            Eigen::Index styles, std::uint64_t seed)
      : vector_size(size) {
    MadeNumbers numbers(seed);
    for (Eigen::Index k = 0; k < size; ++k) {
      w.push_back(numbers.matrix(style_size, content_size));
    }
    expressions = numbers.matrix(style_size, styles);
  }

  Eigen::VectorXd shown(const Eigen::VectorXd& expression, const Eigen::VectorXd& content) const {
    Eigen::VectorXd y(vector_size);
    for (Eigen::Index k = 0; k < vector_size; ++k) {
      y[k] = expression.dot(w[static_cast<std::size_t>(k)] * content);
    }
    return y;
  }

  Eigen::MatrixXd shown_all(const Eigen::VectorXd& expression,
                            const Eigen::MatrixXd& contents) const {
    Eigen::MatrixXd y(vector_size, contents.cols());
    for (Eigen::Index t = 0; t < contents.cols(); ++t) {
      y.col(t) = shown(expression, contents.col(t));
    }
    return y;
  }

  // Every style speaks the contents (J by T), with noise of this amplitude.
  StyleStack speak(const Eigen::MatrixXd& contents, double noise = 0.0,
                   std::uint64_t seed = 99) const {
    MadeNumbers numbers(seed);
    StyleStack stack{.vector_size = vector_size};
    stack.columns = Eigen::MatrixXd(expressions.cols() * vector_size, contents.cols());
    for (Eigen::Index s = 0; s < expressions.cols(); ++s) {
      stack.styles.push_back("style" + std::to_string(s));
      stack.columns.middleRows(s * vector_size, vector_size) =
          shown_all(expressions.col(s), contents);
    }
    stack.columns += noise * numbers.matrix(stack.columns.rows(), stack.columns.cols());
    return stack;
  }
};

// Contents whose first coefficient stays near 3, as a face stays a face.
inline Eigen::MatrixXd made_contents(Eigen::Index size, Eigen::Index count, std::uint64_t seed) {
  Eigen::MatrixXd contents = MadeNumbers(seed).matrix(size, count);
  contents.row(0) = (0.01 * contents.row(0)).array() + 3.0;
  return contents;
}

} // namespace phonomime::test
