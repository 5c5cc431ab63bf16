// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/percentile.h"
#include "tools/evaluate/measure_sums.h"
#include "tools/evaluate/paired_test.h"
#include "tools/evaluate/time_warping.h"

#include "db/types/errors.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

// Numbers in [-1, 1) that are the same everywhere.
std::vector<double> numbers(int count, unsigned seed) {
  std::vector<double> made;
  unsigned state = seed;
  for (int i = 0; i < count; ++i) {
    state = state * 1664525u + 1013904223u;
    made.push_back(static_cast<double>(state >> 8) / (1u << 23) - 1.0);
  }
  return made;
}

TEST(Percentile, IsLinearBetweenTheTwoNearest) {
  std::vector<double> values(101);
  std::iota(values.rbegin(), values.rend(), 0.0);
  EXPECT_EQ(percentile(values, 0.95), 95.0);
  EXPECT_EQ(percentile(values, 0.0), 0.0);
  EXPECT_EQ(percentile(values, 1.0), 100.0);
  EXPECT_NEAR(*percentile({10.0, 30.0, 20.0}, 0.95), 29.0, 1e-12); // 20 + 0.9 * 10
  EXPECT_EQ(percentile({7.0}, 0.95), 7.0);
  EXPECT_FALSE(percentile({}, 0.5));
}

TEST(PairMoments, AddUpToTheWholeAndAgreeWithTwoPasses) {
  const std::vector<double> x = numbers(97, 1);
  const std::vector<double> y = numbers(97, 2);
  PairMoments whole, first, second;
  double mean_x = 0.0, mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double b = y[i] + 0.5 * x[i] + 1000.0; // far from zero
    whole.add(x[i], b);
    (i < 40 ? first : second).add(x[i], b);
    mean_x += x[i] / 97.0;
    mean_y += b / 97.0;
  }
  double sxx = 0.0, syy = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double b = y[i] + 0.5 * x[i] + 1000.0;
    sxx += (x[i] - mean_x) * (x[i] - mean_x);
    syy += (b - mean_y) * (b - mean_y);
    sxy += (x[i] - mean_x) * (b - mean_y);
  }
  first.add(second);
  first.add(PairMoments{});
  for (const PairMoments& moments : {whole, first}) {
    EXPECT_EQ(moments.count, 97);
    EXPECT_NEAR(*moments.correlation(), sxy / std::sqrt(sxx * syy), 1e-10);
    EXPECT_NEAR(*moments.deviation_ratio(), std::sqrt(syy / sxx), 1e-10);
  }
  PairMoments flat;
  for (int i = 0; i < 50; ++i) {
    flat.add(x[i], 0.1);
  }
  EXPECT_FALSE(flat.correlation()); // a constant does not correlate, whatever its rounding
  EXPECT_NEAR(*flat.deviation_ratio(), 0.0, 1e-12);
}

TEST(MeasureSums, OfTwoLayoutsDoNotAddUp) {
  MeasureSums one, other;
  one.group_error_sq = {1.0, 2.0};
  other.group_error_sq = {1.0};
  EXPECT_THROW(one.add(other), InternalError);
}

// The best path found by trying all, and the curve it makes.
std::vector<double> warped_by_trying(const std::vector<double>& recorded,
                                     const std::vector<double>& synthesised, int band) {
  const int n = static_cast<int>(recorded.size());
  const auto standard = [n](std::vector<double> curve) {
    const double mean = std::accumulate(curve.begin(), curve.end(), 0.0) / n;
    double variance = 0.0;
    for (double& value : curve) {
      value -= mean;
      variance += value * value / n;
    }
    for (double& value : curve) {
      value /= std::sqrt(variance);
    }
    return curve;
  };
  const std::vector<double> a = standard(recorded);
  const std::vector<double> b = standard(synthesised);
  std::vector<std::pair<int, int>> path, best;
  double least = std::numeric_limits<double>::infinity();
  const std::function<void(int, int, double)> walk = [&](int i, int j, double cost) {
    if (i >= n || j >= n || std::abs(i - j) > band) {
      return;
    }
    cost += (a[i] - b[j]) * (a[i] - b[j]);
    path.emplace_back(i, j);
    if (i == n - 1 && j == n - 1 && cost < least) {
      least = cost;
      best = path;
    }
    walk(i + 1, j + 1, cost);
    walk(i + 1, j, cost);
    walk(i, j + 1, cost);
    path.pop_back();
  };
  walk(0, 0, 0.0);
  std::vector<double> warped(n, 0.0), count(n, 0.0);
  for (const auto& [i, j] : best) {
    warped[i] += synthesised[j];
    count[i] += 1.0;
  }
  for (int i = 0; i < n; ++i) {
    warped[i] /= count[i];
  }
  return warped;
}

TEST(TimeWarping, FindsThePathThatTryingAllFinds) {
  std::vector<std::int64_t> frames(7);
  std::iota(frames.begin(), frames.end(), 100);
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const std::vector<double> recorded = numbers(7, seed);
    const std::vector<double> synthesised = numbers(7, seed + 100);
    for (const int band : {0, 1, 2, 6}) {
      const auto expected = warped_by_trying(recorded, synthesised, band);
      const auto warped = warp_onto(recorded, synthesised, frames, band);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_NEAR(warped[i], expected[i], 1e-12) << "seed " << seed << ", band " << band;
      }
    }
  }
}

TEST(TimeWarping, UndoesAShiftWithinTheBand) {
  std::vector<double> recorded, synthesised;
  std::vector<std::int64_t> frames;
  for (int k = 0; k < 120; ++k) {
    frames.push_back(k);
    recorded.push_back(3.0 + std::sin(0.15 * k));
    synthesised.push_back(3.0 + std::sin(0.15 * (k - 8)));
  }
  const auto near = [&](std::int64_t band) {
    const auto warped = warp_onto(recorded, synthesised, frames, band);
    double largest = 0.0;
    for (std::size_t i = 20; i < 100; ++i) {
      largest = std::max(largest, std::abs(warped[i] - recorded[i]));
    }
    return largest;
  };
  EXPECT_LT(near(15), 0.15);
  EXPECT_GT(near(2), 0.5);
  EXPECT_EQ(warp_onto(recorded, synthesised, frames, 0), synthesised);
  const std::vector<double> flat(120, 4.0);
  EXPECT_EQ(warp_onto(recorded, flat, frames, 15), flat);
}

TEST(SignedRanks, TheExactChanceIsThatOfTryingAllSigns) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::vector<double> differences = numbers(11, seed);
    differences[3] += 0.8; // lean to one side
    differences[5] += 0.8;
    std::vector<double> magnitudes;
    for (const double difference : differences) {
      magnitudes.push_back(std::abs(difference));
    }
    std::ranges::sort(magnitudes);
    const auto rank = [&](double difference) {
      return 1 + (std::ranges::lower_bound(magnitudes, std::abs(difference)) - magnitudes.begin());
    };
    std::ptrdiff_t positive = 0, all = 0;
    for (const double difference : differences) {
      all += rank(difference);
      positive += difference > 0.0 ? rank(difference) : 0;
    }
    const std::ptrdiff_t off = std::abs(2 * positive - all); // distance from the middle, doubled
    int as_far = 0;
    for (unsigned signs = 0; signs < 2048; ++signs) {
      std::ptrdiff_t sum = 0;
      for (int i = 0; i < 11; ++i) {
        sum += (signs >> i & 1u) != 0 ? i + 1 : 0;
      }
      as_far += std::abs(2 * sum - all) >= off ? 1 : 0;
    }
    EXPECT_NEAR(signed_rank_test(differences).p_value, as_far / 2048.0, 1e-12);
  }
}

TEST(SignedRanks, TiesShareTheirRankAndZerosAreDropped) {
  // Ranks of 1, 1, 1, 2, 2, 3: 2, 2, 2, 4.5, 4.5, 6. Variance 6*7*13/24 - (24 + 6)/48.
  const std::vector<double> differences = {1.0, 0.0, -1.0, 1.0, 2.0, 2.0, 0.0, 3.0};
  const SignedRanks ranks = signed_rank_test(differences);
  EXPECT_EQ(ranks.negative, 2.0);
  EXPECT_EQ(ranks.positive, 19.0);
  const double z = (10.5 - 2.0) / std::sqrt(6.0 * 7.0 * 13.0 / 24.0 - 30.0 / 48.0);
  EXPECT_NEAR(ranks.p_value, std::erfc(z / std::sqrt(2.0)), 1e-12);
  EXPECT_EQ(signed_rank_test(std::vector<double>{0.0, 0.0}).p_value, 1.0);
  EXPECT_EQ(signed_rank_test(std::vector<double>{}).p_value, 1.0);
  EXPECT_EQ(signed_rank_test(std::vector<double>{2.5}).p_value, 1.0); // 2 of 2 signs
}

TEST(SignedRanks, TheNormalApproximationMeetsTheExactChance) {
  std::vector<double> differences = numbers(50, 9);
  for (double& difference : differences) {
    difference += 0.2;
  }
  const double exact = signed_rank_test(differences).p_value;
  differences.push_back(1e-9); // the 51st, of the least rank
  EXPECT_NEAR(signed_rank_test(differences).p_value, exact, 0.02);
  EXPECT_LT(exact, 0.2);
}

TEST(Holm, AdjustsAsItsAuthorDoes) {
  const std::vector<double> p = {0.01, 0.04, 0.03, 0.005};
  const std::vector<double> adjusted = holm_adjusted(p);
  const std::vector<double> expected = {0.03, 0.06, 0.06, 0.02};
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_NEAR(adjusted[i], expected[i], 1e-12);
  }
  EXPECT_EQ(holm_adjusted(std::vector<double>{0.7, 0.6}), (std::vector<double>{1.0, 1.0}));
}

} // namespace
} // namespace phonomime::test
