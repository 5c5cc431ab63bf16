// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tune/many_starts.h"

#include "db/types/errors.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <numeric>
#include <utility>

namespace phonomime {

namespace {

// SplitMix64: the same numbers everywhere.
class Lots {
public:
  explicit Lots(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t lot = state_ += 0x9e3779b97f4a7c15u;
    lot = (lot ^ (lot >> 30)) * 0xbf58476d1ce4e5b9u;
    lot = (lot ^ (lot >> 27)) * 0x94d049bb133111ebu;
    return lot ^ (lot >> 31);
  }
  double share() { return static_cast<double>(next() >> 11) * 0x1p-53; } // 0 to 1, 1 excluded

private:
  std::uint64_t state_;
};

// Runs pieces of work that may throw; the first failure in their order comes out.
void run_all(std::size_t count, const ShareOut& share_out,
             const std::function<void(std::size_t i)>& work) {
  std::vector<std::exception_ptr> failures(count);
  std::atomic<bool> failed = false;
  share_out(count, [&](std::size_t i) {
    if (failed) {
      return;
    }
    try {
      work(i);
    } catch (...) {
      failures[i] = std::current_exception();
      failed = true;
    }
  });
  for (const std::exception_ptr& failure : failures) {
    if (failure) {
      std::rethrow_exception(failure);
    }
  }
}

// The best of some looks, the earlier of equal ones first, without repetitions.
std::vector<Look> best_of(std::vector<Look> looks, int count) {
  std::ranges::stable_sort(looks, {}, &Look::value);
  std::vector<Look> best;
  for (Look& look : looks) {
    if (best.size() < static_cast<std::size_t>(count) &&
        std::ranges::find(best, look.point, &Look::point) == best.end()) {
      best.push_back(std::move(look));
    }
  }
  return best;
}

} // namespace

const Look& Search::best() const {
  if (looks.empty()) {
    throw InternalError({.what = "no point has been looked at"});
  }
  return *std::ranges::min_element(looks, {}, &Look::value);
}

std::vector<std::vector<double>> draw_points(std::size_t sides, std::size_t count,
                                             std::uint64_t seed) {
  Lots lots(seed);
  std::vector<std::vector<double>> points(count, std::vector<double>(sides));
  for (std::size_t side = 0; side < sides; ++side) {
    std::vector<std::size_t> parts(count);
    std::iota(parts.begin(), parts.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i) {
      std::swap(parts[i - 1], parts[lots.next() % i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      points[i][side] = (static_cast<double>(parts[i]) + lots.share()) / static_cast<double>(count);
    }
  }
  return points;
}

std::vector<Search> search_from_many_starts(std::span<const Objective> objectives,
                                            std::span<const double> first_point,
                                            const ManyStarts& options, const ShareOut& share_out) {
  std::vector<std::vector<double>> points =
      draw_points(first_point.size(), static_cast<std::size_t>(options.starts), options.seed);
  points.insert(points.begin(), {first_point.begin(), first_point.end()});
  std::vector<std::optional<double>> values(objectives.size() * points.size());
  run_all(values.size(), share_out, [&](std::size_t i) {
    values[i] = objectives[i / points.size()](points[i % points.size()]);
  });
  std::vector<Search> searches(objectives.size());
  std::vector<std::pair<std::size_t, Look>> starts;
  for (std::size_t o = 0; o < objectives.size(); ++o) {
    std::vector<Look>& looks = searches[o].looks;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (const std::optional<double> value = values[o * points.size() + i]) {
        looks.push_back({.point = points[i], .value = *value});
      }
    }
    for (Look& look : best_of(looks, options.descents)) {
      starts.emplace_back(o, std::move(look));
    }
  }
  std::vector<std::vector<Look>> descents(starts.size());
  run_all(starts.size(), share_out, [&](std::size_t i) {
    descents[i] = descend(objectives[starts[i].first], starts[i].second.point, options.evaluations);
  });
  for (std::size_t i = 0; i < starts.size(); ++i) {
    std::vector<Look>& looks = searches[starts[i].first].looks;
    looks.insert(looks.end(), descents[i].begin(), descents[i].end());
  }
  return searches;
}

} // namespace phonomime
