// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads problems from stdin and prints the answers of BoundedLeastSquares, a line each.
//
//     ROWS UNKNOWNS LOWER UPPER GOALS     a system's; UPPER may be inf
//     A row by row, then each goal b      ROWS * UNKNOWNS, then GOALS * ROWS numbers
//
// The goals of a system are solved one after the other, each from the answer before it.
#include "synth/retarget/bounded_least_squares.h"

#include <cstdlib>
#include <iostream>
#include <string>

#include <fmt/format.h>

namespace {

double read_number() {
  std::string word; // operator>> does not read "inf"
  std::cin >> word;
  return std::strtod(word.c_str(), nullptr);
}

Eigen::MatrixXd read_matrix(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) {
      matrix(i, j) = read_number();
    }
  }
  return matrix;
}

} // namespace

int main() {
  Eigen::Index rows = 0, unknowns = 0;
  while (std::cin >> rows >> unknowns) {
    const double lower = read_number();
    const double upper = read_number();
    const auto goals = static_cast<Eigen::Index>(read_number());
    const Eigen::MatrixXd a = read_matrix(rows, unknowns);
    phonomime::BoundedLeastSquares solver(a.transpose() * a,
                                          Eigen::VectorXd::Constant(unknowns, lower),
                                          Eigen::VectorXd::Constant(unknowns, upper));
    for (Eigen::Index k = 0; k < goals; ++k) {
      const Eigen::MatrixXd goal = read_matrix(1, rows);
      std::string line;
      for (const double value : solver.solve(a.transpose() * goal.transpose())) {
        line += fmt::format("{:.17g} ", value);
      }
      std::cout << line << "\n";
    }
  }
  return 0;
}
