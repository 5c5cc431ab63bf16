// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/bounded_least_squares.h"

#include "db/types/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace phonomime {
namespace {

// Of the problem's own scale: a gradient under it counts as zero.
constexpr double kGradientTolerance = 1e-12;
// Of a column's squared length: what is left of it beside the free columns, below which it counts
// as one of their combinations.
constexpr double kDependence = 1e-12;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Exchanges that do not lessen the number of unknowns at the wrong place, before one gives up.
constexpr int kPatience = 2;

} // namespace

BoundedLeastSquares::BoundedLeastSquares(Eigen::MatrixXd gram, Eigen::VectorXd lower,
                                         Eigen::VectorXd upper)
    : gram_(std::move(gram)), lower_(std::move(lower)), upper_(std::move(upper)) {
  const Eigen::Index n = gram_.rows();
  if (gram_.cols() != n || lower_.size() != n || upper_.size() != n || !gram_.allFinite() ||
      !lower_.allFinite() || !(lower_.array() < upper_.array()).all() ||
      (gram_.diagonal().array() < 0.0).any()) {
    throw InternalError({.what = "a least squares problem with bounds is malformed"});
  }
  lengths_ = gram_.diagonal().cwiseSqrt();
  factor_ = Eigen::MatrixXd::Zero(n, n);
  states_.resize(static_cast<std::size_t>(n));
  rejected_.resize(static_cast<std::size_t>(n));
  free_.reserve(static_cast<std::size_t>(n));
  scratch_.resize(n);
  inverse_.resize(n);
  start_cold();
}

void BoundedLeastSquares::start_cold() {
  x_ = lower_;
  std::ranges::fill(states_, State::at_lower);
  keep_free(0);
}

void BoundedLeastSquares::start_from(const Eigen::Ref<const Eigen::VectorXd>& x) {
  if (x.size() != unknown_count() || x.hasNaN()) {
    throw InternalError({.what = "a start does not fit the least squares problem"});
  }
  x_ = x.cwiseMax(lower_).cwiseMin(upper_);
  keep_free(0);
  for (int i = 0; i < unknown_count(); ++i) {
    State& state = states_[static_cast<std::size_t>(i)];
    state = x_[i] <= lower_[i]   ? State::at_lower
            : x_[i] >= upper_[i] ? State::at_upper
                                 : State::free;
    // An unknown that depends on those before it rests at a bound for a start.
    if (state == State::free && !append(i)) {
      stop_at_bound(i, State::at_lower);
    }
  }
}

// Leaves the first `count` columns of the factor.
void BoundedLeastSquares::keep_free(std::size_t count) {
  free_.resize(count);
  clean_ = std::min(clean_, count);
}

// The column of R that an unknown would add, into scratch_ and, at its end, the root of what is
// left of the column. False where it depends on the free ones.
bool BoundedLeastSquares::try_factor(int unknown) {
  const auto count = static_cast<Eigen::Index>(free_.size());
  double left = gram_(unknown, unknown);
  for (Eigen::Index i = 0; i < count; ++i) {
    double value = gram_(free_[static_cast<std::size_t>(i)], unknown);
    value -= factor_.col(i).head(i).dot(scratch_.head(i));
    value *= inverse_[i];
    scratch_[i] = value;
    left -= value * value;
  }
  if (!(left > kDependence * gram_(unknown, unknown))) {
    return false;
  }
  scratch_[count] = std::sqrt(left);
  return true;
}

bool BoundedLeastSquares::append(int unknown) {
  if (!try_factor(unknown)) {
    return false;
  }
  const auto count = static_cast<Eigen::Index>(free_.size());
  factor_.col(count).head(count + 1) = scratch_.head(count + 1);
  inverse_[count] = 1.0 / scratch_[count];
  clean_ += clean_ == free_.size() ? 1 : 0;
  free_.push_back(unknown);
  states_[static_cast<std::size_t>(unknown)] = State::free;
  return true;
}

// Takes a column out of R and turns what it leaves triangular again by Givens rotations.
void BoundedLeastSquares::remove(std::size_t place) {
  const auto count = static_cast<Eigen::Index>(free_.size());
  for (auto column = static_cast<Eigen::Index>(place) + 1; column < count; ++column) {
    factor_.col(column - 1).head(column + 1) = factor_.col(column).head(column + 1);
  }
  for (auto i = static_cast<Eigen::Index>(place); i + 1 < count; ++i) {
    const double a = factor_(i, i);
    const double b = factor_(i + 1, i);
    const double length = std::hypot(a, b);
    const double c = a / length;
    const double s = b / length;
    factor_(i, i) = length;
    inverse_[i] = 1.0 / length;
    factor_(i + 1, i) = 0.0;
    for (Eigen::Index column = i + 1; column + 1 < count; ++column) {
      const double above = factor_(i, column);
      const double below = factor_(i + 1, column);
      factor_(i, column) = c * above + s * below;
      factor_(i + 1, column) = c * below - s * above;
    }
  }
  free_.erase(free_.begin() + static_cast<std::ptrdiff_t>(place));
  clean_ = std::min(clean_, place);
}

// R'R values = values, #free.
void BoundedLeastSquares::solve_factor(Eigen::VectorXd& values) const {
  const Eigen::Index count = values.size();
  for (Eigen::Index i = 0; i < count; ++i) {
    values[i] = (values[i] - factor_.col(i).head(i).dot(values.head(i))) * inverse_[i];
  }
  for (Eigen::Index i = count - 1; i >= 0; --i) {
    values[i] *= inverse_[i];
    values.head(i) -= values[i] * factor_.col(i).head(i);
  }
}

void BoundedLeastSquares::stop_at_bound(int unknown, State state) {
  states_[static_cast<std::size_t>(unknown)] = state;
  x_[unknown] = state == State::at_lower ? lower_[unknown] : upper_[unknown];
}

// The share of a change of one unknown after which it meets a bound; infinity where it meets none.
double BoundedLeastSquares::share_to_bound(int unknown, double change) const {
  if (change == 0.0) {
    return kInfinity;
  }
  const double room = (change < 0.0 ? lower_[unknown] : upper_[unknown]) - x_[unknown];
  return room / change;
}

// Moves the free unknowns by a share of the change (#free); those that meet a bound stop there.
void BoundedLeastSquares::advance(const Eigen::VectorXd& change, double share) {
  for (std::size_t place = free_.size(); place-- > 0;) {
    const int unknown = free_[place];
    const double step = change[static_cast<Eigen::Index>(place)];
    const bool meets = share_to_bound(unknown, step) <= share * (1.0 + 1e-14);
    x_[unknown] += share * step;
    if (meets || x_[unknown] <= lower_[unknown] || x_[unknown] >= upper_[unknown]) {
      stop_at_bound(unknown, step < 0.0 ? State::at_lower : State::at_upper);
      remove(place);
      ++steps_;
    }
  }
}

// Moves to the least over the free unknowns, stopping at bounds on the way. False where `entering`
// (just set free, or -1) would not leave its bound: rounding alone had said it should.
bool BoundedLeastSquares::descend(int entering) {
  while (!free_.empty()) {
    const auto count = static_cast<Eigen::Index>(free_.size());
    change_.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const int unknown = free_[static_cast<std::size_t>(i)];
      change_[i] = right_[unknown] - gram_.col(unknown).dot(x_);
    }
    solve_factor(change_);
    if (entering >= 0) {
      const double step = change_[count - 1];
      if (!(step * (x_[entering] > lower_[entering] ? -1.0 : 1.0) > 0.0)) {
        stop_at_bound(entering,
                      x_[entering] > lower_[entering] ? State::at_upper : State::at_lower);
        remove(free_.size() - 1);
        return false;
      }
      entering = -1;
    }
    double share = kInfinity;
    for (Eigen::Index i = 0; i < count; ++i) {
      share = std::min(share, share_to_bound(free_[static_cast<std::size_t>(i)], change_[i]));
    }
    if (share > 1.0) {
      for (Eigen::Index i = 0; i < count; ++i) {
        x_[free_[static_cast<std::size_t>(i)]] += change_[i];
      }
      return true;
    }
    advance(change_, share);
  }
  return true;
}

// The unknown at a bound that the cost most wants inside, by the length of its column; -1 where
// there is none.
int BoundedLeastSquares::worst_at_bound() const {
  int worst = -1;
  double worst_pull = kGradientTolerance * scale_;
  for (int i = 0; i < unknown_count(); ++i) {
    const State state = states_[static_cast<std::size_t>(i)];
    if (state == State::free || rejected_[static_cast<std::size_t>(i)] || lengths_[i] == 0.0) {
      continue;
    }
    const double slope = (right_[i] - gram_.col(i).dot(x_)) / lengths_[i];
    const double pull = state == State::at_lower ? slope : -slope;
    if (pull > worst_pull) {
      worst = i;
      worst_pull = pull;
    }
  }
  return worst;
}

// Sets an unknown at a bound free and goes to the least. Where its column depends on the free ones,
// the cost is linear along the direction that changes nothing else: down to the first bound.
void BoundedLeastSquares::release(int unknown) {
  const State from = states_[static_cast<std::size_t>(unknown)];
  const auto index = static_cast<std::size_t>(unknown);
  ++steps_;
  if (append(unknown)) {
    rejected_[index] = !descend(unknown);
    return;
  }
  const auto count = static_cast<Eigen::Index>(free_.size());
  const double sign = from == State::at_lower ? 1.0 : -1.0;
  change_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    change_[i] = -sign * gram_(free_[static_cast<std::size_t>(i)], unknown);
  }
  solve_factor(change_);
  double share = upper_[unknown] - lower_[unknown];
  for (Eigen::Index i = 0; i < count; ++i) {
    share = std::min(share, share_to_bound(free_[static_cast<std::size_t>(i)], change_[i]));
  }
  if (share == kInfinity) {
    rejected_[index] = 1;
    return;
  }
  const bool crosses = share == upper_[unknown] - lower_[unknown];
  const double start = x_[unknown];
  advance(change_, share);
  x_[unknown] = start + sign * share;
  if (crosses) {
    stop_at_bound(unknown, from == State::at_lower ? State::at_upper : State::at_lower);
  } else if (!append(unknown)) {
    stop_at_bound(unknown, from);
    rejected_[index] = 1;
  }
  descend(-1);
}

// R of the free unknowns in their own order, with what is there of it. False where one depends on
// those before it.
bool BoundedLeastSquares::factor_in_order() {
  std::size_t place = 0;
  bool kept = true;
  for (int unknown = 0; unknown < unknown_count(); ++unknown) {
    if (states_[static_cast<std::size_t>(unknown)] != State::free) {
      continue;
    }
    kept = kept && place < clean_ && free_[place] == unknown;
    if (!kept) {
      keep_free(place);
      if (!append(unknown)) {
        return false;
      }
    }
    ++place;
  }
  keep_free(place);
  return true;
}

// The least over the free unknowns, the others at their bounds, wherever that lies.
void BoundedLeastSquares::place_free() {
  slope_ = right_;
  for (int held = 0; held < unknown_count(); ++held) {
    if (states_[static_cast<std::size_t>(held)] != State::free && x_[held] != 0.0) {
      slope_ -= x_[held] * gram_.col(held);
    }
  }
  const auto count = static_cast<Eigen::Index>(free_.size());
  change_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    change_[i] = slope_[free_[static_cast<std::size_t>(i)]];
  }
  solve_factor(change_);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int unknown = free_[static_cast<std::size_t>(i)];
    x_[unknown] = change_[i];
    slope_ -= change_[i] * gram_.col(unknown);
  }
}

// Puts every unknown that is out of its bounds at them, and sets every one free that the cost wants
// inside: how many.
int BoundedLeastSquares::exchange_wrong() {
  int wrong = 0;
  for (int i = 0; i < unknown_count(); ++i) {
    State& state = states_[static_cast<std::size_t>(i)];
    if (state == State::free) {
      if (x_[i] < lower_[i] || x_[i] > upper_[i]) {
        stop_at_bound(i, x_[i] < lower_[i] ? State::at_lower : State::at_upper);
        ++wrong;
      }
    } else if ((state == State::at_lower ? slope_[i] : -slope_[i]) >
               kGradientTolerance * scale_ * lengths_[i]) {
      state = State::free;
      ++wrong;
    }
  }
  steps_ += wrong;
  return wrong;
}

// Exchanges whole sets of unknowns until none is at the wrong place: the least then, mostly after
// a few rounds. False where that does not get anywhere, with the unknowns anywhere.
bool BoundedLeastSquares::exchange_all() {
  int fewest = std::numeric_limits<int>::max();
  for (int patience = kPatience; patience > 0;) {
    if (!factor_in_order()) {
      return false;
    }
    place_free();
    const int wrong = exchange_wrong();
    if (wrong == 0) {
      return true;
    }
    patience = wrong < fewest ? kPatience : patience - 1;
    fewest = std::min(fewest, wrong);
  }
  return false;
}

// The active-set method proper.
void BoundedLeastSquares::step_by_step() {
  descend(-1);
  // Each step lowers the cost, so that no set of free unknowns comes twice; the limit is for
  // rounding.
  const int limit = steps_ + 100 + 20 * static_cast<int>(unknown_count());
  for (int unknown = worst_at_bound(); unknown >= 0 && steps_ < limit; unknown = worst_at_bound()) {
    release(unknown);
  }
  const Eigen::VectorXd found = x_;
  if (factor_in_order()) { // else free ones are nearly dependent: what led here stays
    place_free();
    x_ = x_.cwiseMax(lower_).cwiseMin(upper_);
  } else {
    start_from(found);
  }
}

const Eigen::VectorXd& BoundedLeastSquares::solve(const Eigen::Ref<const Eigen::VectorXd>& right) {
  if (right.size() != unknown_count() || !right.allFinite()) {
    throw InternalError({.what = "a right side does not fit the least squares problem"});
  }
  right_ = right;
  std::ranges::fill(rejected_, char{0});
  steps_ = 0;
  scale_ = 0.0;
  for (Eigen::Index i = 0; i < unknown_count(); ++i) {
    if (lengths_[i] > 0.0) {
      scale_ = std::max({scale_, std::abs(right_[i]) / lengths_[i], lengths_[i] * std::abs(x_[i])});
    }
  }
  start_ = x_;
  if (!exchange_all()) {
    start_from(start_);
    step_by_step();
  }
  return x_;
}

} // namespace phonomime
