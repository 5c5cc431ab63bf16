// SPDX-License-Identifier: GPL-3.0-or-later
//
// Objectives whose least value is known.
#include "tools/tune/many_starts.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

namespace phonomime {
namespace {

constexpr double kPi = 3.141592653589793;

void one_by_one(std::size_t count, const std::function<void(std::size_t i)>& body) {
  for (std::size_t i = 0; i < count; ++i) {
    body(i);
  }
}

void four_at_a_time_backwards(std::size_t count, const std::function<void(std::size_t i)>& body) {
  std::atomic<std::size_t> left = count;
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (std::size_t i = left.fetch_sub(1); i > 0 && i <= count; i = left.fetch_sub(1)) {
        body(i - 1);
      }
    });
  }
}

// A valley that lies askew, with its lowest point where `at` is: 3 there.
Objective quadratic(std::vector<double> at) {
  return [at](std::span<const double> point) {
    double sum = 3.0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double off = point[i] - at[i];
      const double next = point[(i + 1) % at.size()] - at[(i + 1) % at.size()];
      sum += static_cast<double>(i + 1) * off * off + 0.4 * off * next;
    }
    return std::optional(sum);
  };
}

// Rastrigin's: a valley every fifth of a side, the lowest around `at`, where it is 0.
Objective rugged(double at) {
  return [at](std::span<const double> point) {
    double sum = 0.0;
    for (const double x : point) {
      sum += 4.0 * (x - at) * (x - at) + 1.0 - std::cos(10.0 * kPi * (x - at));
    }
    return std::optional(sum);
  };
}

TEST(Descend, FindsTheBottomOfAQuadraticValley) {
  const std::vector<double> at = {0.3, 0.62, 0.8};
  const std::vector<Look> looks = descend(quadratic(at), std::vector{0.7, 0.2, 0.4}, 100, 1e-6);
  const Search search{.looks = looks};
  EXPECT_EQ(looks.front().point, (std::vector{0.7, 0.2, 0.4}));
  EXPECT_NEAR(search.best().value, 3.0, 1e-6);
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_NEAR(search.best().point[i], at[i], 1e-3);
  }
}

TEST(Descend, FindsABottomOutsideOfTheBoxOnItsSide) {
  const std::vector<Look> looks = descend(quadratic({-0.4, 0.5}), std::vector{0.5, 0.5}, 100, 1e-6);
  for (const Look& look : looks) {
    for (const double x : look.point) {
      EXPECT_GE(x, 0.0);
      EXPECT_LE(x, 1.0);
    }
  }
  EXPECT_NEAR(Search{looks}.best().point[0], 0.0, 1e-9);
}

TEST(Descend, TakesABoxOfOneSide) {
  const std::vector<Look> looks = descend(quadratic({0.23}), std::vector{0.9}, 60, 1e-5);
  EXPECT_NEAR(Search{looks}.best().point[0], 0.23, 1e-2);
}

TEST(Descend, LooksAtMostAsOftenAsItMay) {
  EXPECT_EQ(descend(quadratic({0.3, 0.6, 0.8}), std::vector{0.7, 0.2, 0.4}, 9, 1e-9).size(), 9u);
}

TEST(Descend, EndsWhereNothingIsToBeAskedAnyMore) {
  int asked = 0;
  const Objective tired = [&](std::span<const double> point) -> std::optional<double> {
    return ++asked > 5 ? std::nullopt : quadratic({0.3, 0.6})(point);
  };
  EXPECT_EQ(descend(tired, std::vector{0.7, 0.2}, 100).size(), 5u);
}

TEST(Descend, LetsExceptionsThrough) {
  struct Own : std::exception {};
  const Objective failing = [](std::span<const double>) -> std::optional<double> { throw Own(); };
  EXPECT_THROW(descend(failing, std::vector{0.5, 0.5}, 10), Own);
}

TEST(DrawPoints, PutsOnePointIntoEachPartOfEachSide) {
  const std::size_t count = 17;
  const auto points = draw_points(3, count, 5);
  ASSERT_EQ(points.size(), count);
  for (std::size_t side = 0; side < 3; ++side) {
    std::vector<int> in_part(count, 0);
    for (const auto& point : points) {
      ++in_part.at(static_cast<std::size_t>(point[side] * static_cast<double>(count)));
    }
    EXPECT_EQ(in_part, std::vector<int>(count, 1));
  }
  EXPECT_EQ(draw_points(3, count, 5), points);
  EXPECT_NE(draw_points(3, count, 6), points);
  EXPECT_NE(points[0][0], points[0][1]);
}

TEST(ManyStarts, FindTheLowestOfManyValleysWhereOneDescentDoesNot) {
  const std::vector<Objective> objectives = {rugged(0.81)};
  const std::vector<double> first = {0.2, 0.2};
  const auto best = [&](const ManyStarts& options) {
    return search_from_many_starts(objectives, first, options, one_by_one).front().best();
  };
  const Look alone = best({.starts = 0, .descents = 1, .evaluations = 80});
  const Look many = best({.starts = 60, .descents = 6, .evaluations = 80});
  EXPECT_GT(alone.value, 0.1);
  EXPECT_LT(many.value, 0.01);
  EXPECT_NEAR(many.point[0], 0.81, 0.02);
  EXPECT_NEAR(many.point[1], 0.81, 0.02);
}

TEST(ManyStarts, ComeToTheSameInAnyOrderAndAtAnyNumberOfThreads) {
  const std::vector<Objective> objectives = {rugged(0.81), quadratic({0.4, 0.7}), rugged(0.33)};
  const std::vector<double> first = {0.2, 0.6};
  const ManyStarts options{.starts = 12, .descents = 3, .evaluations = 25, .seed = 7};
  const auto ours = search_from_many_starts(objectives, first, options, one_by_one);
  const auto theirs = search_from_many_starts(objectives, first, options, four_at_a_time_backwards);
  ASSERT_EQ(ours.size(), 3u);
  for (std::size_t o = 0; o < ours.size(); ++o) {
    ASSERT_EQ(ours[o].looks.size(), theirs[o].looks.size());
    EXPECT_EQ(ours[o].looks.front().point, first);
    for (std::size_t i = 0; i < ours[o].looks.size(); ++i) {
      EXPECT_EQ(ours[o].looks[i].point, theirs[o].looks[i].point);
      EXPECT_EQ(ours[o].looks[i].value, theirs[o].looks[i].value);
    }
  }
}

TEST(ManyStarts, LetTheFirstFailureThrough) {
  const Objective failing = [](std::span<const double> point) -> std::optional<double> {
    throw std::runtime_error(point[0] == 0.5 ? "first" : "other");
  };
  try {
    search_from_many_starts(std::vector{failing}, std::vector{0.5, 0.5}, {.starts = 3}, one_by_one);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "first");
  }
}

} // namespace
} // namespace phonomime
