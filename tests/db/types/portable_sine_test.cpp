// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/portable_sine.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

TEST(PortableSine, IsTheLibrarysSineToTheLastPlaces) {
  for (int k = -80000; k <= 80000; ++k) {
    const double x = k / 9973.0;
    const long double exact =
        std::sin(std::numbers::pi_v<long double> * static_cast<long double>(x));
    ASSERT_NEAR(sin_pi(x), static_cast<double>(exact), 4e-16) << x;
  }
}

TEST(PortableSine, IsExactAtWholeAndHalfNumbers) {
  for (int k = -50; k <= 50; ++k) {
    EXPECT_EQ(sin_pi(k), 0.0);
    EXPECT_EQ(sin_pi(k + 0.5), k % 2 == 0 ? 1.0 : -1.0);
  }
}

TEST(PortableSine, IsOddAndOfPeriodTwo) {
  for (int k = 0; k < 4096; ++k) {
    const double x = k / 1024.0;
    EXPECT_EQ(sin_pi(-x), -sin_pi(x));
    EXPECT_EQ(sin_pi(x + 2.0), sin_pi(x));
  }
}

} // namespace
} // namespace phonomime
