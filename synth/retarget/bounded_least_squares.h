// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

namespace phonomime {

// Least squares with bounds: the x between `lower` and `upper` that minimises
//     x' G x / 2 - r' x,
// where G = A'A and r = A'b for |Ax - b|^2 (T Eq. 3.2 with lower 0 and no upper bound). A ridge
// adds to G's diagonal, a linear cost of x takes away from r.
//
// Each solve starts from the answer before it. Whole sets of unknowns change places between bounds
// and inside (block principal pivoting: Judice & Pires 1994; Kim & Park 2011), which takes a few
// rounds. Where that does not settle, or columns depend on each other, a primal active-set method
// follows (Lawson & Hanson 1974, chapter 23; Stark & Parker 1995), which ends for any positive
// semidefinite G: it lowers the cost with every step; an unknown whose column depends on those
// inside moves along the null direction.
//
// The Gram matrix is made once; of the free unknowns' Cholesky factor as much is kept as stays
// right. The answer comes from a factor in the unknowns' own order, so that it has the same bits
// whatever it started from (dependent columns leave a choice).
class BoundedLeastSquares {
public:
  // `gram`: n by n, symmetric, positive semidefinite. `lower`, `upper`: n, lower < upper, lower
  // finite, upper finite or infinity. Throws InternalError where sizes or values break this.
  BoundedLeastSquares(Eigen::MatrixXd gram, Eigen::VectorXd lower, Eigen::VectorXd upper);

  // `right`: n, finite. The answer's optimality (KKT) conditions hold to about 1e-12 of the
  // problem's own scale. Throws InternalError where `right` does not fit.
  const Eigen::VectorXd& solve(const Eigen::Ref<const Eigen::VectorXd>& right);

  // The next solve starts from x (n; what is out of bounds is brought in).
  void start_from(const Eigen::Ref<const Eigen::VectorXd>& x);
  // The next solve starts with every unknown at its lower bound.
  void start_cold();

  Eigen::Index unknown_count() const { return gram_.rows(); }
  // Steps of the last solve (an unknown set free, or stopped at a bound).
  int steps() const { return steps_; }

private:
  enum class State : char { at_lower, free, at_upper };

  bool exchange_all();
  int exchange_wrong();
  void place_free();
  void step_by_step();
  bool descend(int entering);
  void release(int unknown);
  int worst_at_bound() const;
  double share_to_bound(int unknown, double change) const;
  void advance(const Eigen::VectorXd& change, double share);
  void stop_at_bound(int unknown, State state);

  bool factor_in_order();
  bool try_factor(int unknown);
  bool append(int unknown);
  void remove(std::size_t place);
  void keep_free(std::size_t count);
  void solve_factor(Eigen::VectorXd& values) const;

  Eigen::MatrixXd gram_;
  Eigen::VectorXd lower_, upper_;
  Eigen::VectorXd lengths_; // of A's columns: roots of the Gram matrix' diagonal
  Eigen::VectorXd right_;
  Eigen::VectorXd x_, start_;
  Eigen::VectorXd slope_; // right - G x, n
  std::vector<State> states_;
  std::vector<int> free_;      // unknowns in the factor, in its order
  std::size_t clean_ = 0;      // leading columns of the factor that no rotation has touched
  Eigen::MatrixXd factor_;     // R, upper triangular, leading #free by #free: R'R = G of the free
  Eigen::VectorXd inverse_;    // of R's diagonal
  Eigen::VectorXd scratch_;    // #free
  Eigen::VectorXd change_;     // #free (+ 1)
  std::vector<char> rejected_; // would not move although the gradient says so: rounding
  double scale_ = 0.0;         // of the right side, as a length
  int steps_ = 0;
};

} // namespace phonomime
