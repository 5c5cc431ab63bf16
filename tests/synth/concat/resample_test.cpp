// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/resample.h"

#include "db/types/errors.h"
#include "db/types/frame_times.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr double kPi = std::numbers::pi;

CoefficientMotion sampled(double rate_hz, double end_s,
                          const std::function<double(double)>& curve) {
  CoefficientMotion motion;
  motion.rate_hz = rate_hz;
  motion.coefficients.resize(frame_count_to(end_s, rate_hz), 1);
  for (Eigen::Index k = 0; k < motion.coefficients.rows(); ++k) {
    motion.coefficients(k, 0) = curve(static_cast<double>(k) / rate_hz);
  }
  return motion;
}

// The largest error against the curve, over the samples that are `margin_s` away from the ends.
double worst(const CoefficientMotion& motion, double end_s, double margin_s,
             const std::function<double(double)>& curve) {
  double result = 0.0;
  for (Eigen::Index k = 0; k < motion.coefficients.rows(); ++k) {
    const double t = static_cast<double>(k) / motion.rate_hz;
    if (t >= margin_s && t <= end_s - margin_s) {
      result = std::max(result, std::abs(motion.coefficients(k, 0) - curve(t)));
    }
  }
  return result;
}

const std::vector<double> kRates = {24, 25, 29.97, 30, 50, 59.94, 60, 100, 120, 240};

TEST(Resample, CopiesAtItsOwnRateBitForBit) {
  std::mt19937 random(6);
  std::normal_distribution<double> value(0.0, 10.0);
  for (const double rate : kRates) {
    CoefficientMotion motion = sampled(rate, 2.0, [&](double) { return value(random); });
    const CoefficientMotion same = resample_motion(motion, rate, 2.0);
    EXPECT_TRUE(same.coefficients == motion.coefficients) << rate;
    EXPECT_EQ(same.rate_hz, rate);
  }
}

TEST(Resample, HasASampleForEveryTimeUpToTheEndAndNoneAfter) {
  const CoefficientMotion motion = sampled(100.0, 7.0, [](double t) { return t; });
  for (const int thousandths : {24000, 25000, 29970, 30000, 50000, 60000, 100000, 120000}) {
    for (std::int64_t end = 0; end <= 700000; end += 997) { // in units of 10 microseconds
      const double fps = thousandths / 1000.0;
      const double end_s = static_cast<double>(end) / 1e5;
      const std::int64_t expected = end * thousandths / 100000000 + 1; // exact, in whole numbers
      ASSERT_EQ(frame_count_to(end_s, fps), expected) << end_s << " s at " << fps;
    }
    for (std::int64_t k = 0; k < 2000; ++k) { // ends that are samples, however they round
      const double fps = thousandths / 1000.0;
      ASSERT_EQ(frame_count_to(static_cast<double>(k) / fps, fps), k + 1);
      ASSERT_EQ(frame_count_to(static_cast<double>(k) * (1.0 / fps), fps), k + 1);
    }
    const double end_s = 6.37;
    const double fps = thousandths / 1000.0;
    EXPECT_EQ(resample_motion(motion, fps, end_s).coefficients.rows(), frame_count_to(end_s, fps));
  }
}

TEST(Resample, KeepsConstantsExactly) {
  for (const double from : kRates) {
    const CoefficientMotion motion = sampled(from, 1.7, [](double) { return 0.1; });
    for (const double to : kRates) {
      const CoefficientMotion result = resample_motion(motion, to, 1.7);
      EXPECT_TRUE((result.coefficients.array() == 0.1).all()) << from << " to " << to;
    }
  }
}

TEST(Resample, KeepsTimeAndEdges) { // a ramp is time itself: drift, delay and ringing would show
  const double end_s = 20.0;
  const auto time = [](double t) { return t; };
  for (const double from : {100.0, 120.0, 59.94}) {
    for (const double to : kRates) {
      const CoefficientMotion result = resample_motion(sampled(from, end_s, time), to, end_s);
      EXPECT_LT(worst(result, end_s, 1.01 / from, time), 2e-4) << from << " to " << to;
      EXPECT_NEAR(result.coefficients(0, 0), 0.0, 1e-15);
      const double last_frame = std::floor(end_s * from + 1e-6) / from; // held after it
      EXPECT_NEAR(result.coefficients(result.coefficients.rows() - 1, 0),
                  std::min(last_frame, static_cast<double>(result.coefficients.rows() - 1) / to),
                  2e-4);
    }
  }
}

TEST(Resample, PassesWhatTheLowerRateCarriesAndStopsWhatItCannot) {
  const double end_s = 6.0;
  for (const double from : {100.0, 120.0}) {
    for (const double to : {24.0, 29.97, 30.0, 60.0, 120.0, 240.0}) {
      const double nyquist = 0.5 * std::min(from, to);
      for (const double share : {0.05, 0.2, 0.4, 0.6, 0.7}) {
        const auto wave = [&](double t) { return std::sin(2 * kPi * share * nyquist * t + 0.3); };
        const CoefficientMotion result = resample_motion(sampled(from, end_s, wave), to, end_s);
        EXPECT_LT(worst(result, end_s, 0.6, wave), 0.01) << from << " to " << to << " at " << share;
      }
      for (double share = 1.35; share * nyquist <= 0.5 * from; share += 0.2) {
        const auto wave = [&](double t) { return std::sin(2 * kPi * share * nyquist * t + 0.3); };
        const CoefficientMotion result = resample_motion(sampled(from, end_s, wave), to, end_s);
        EXPECT_LT(worst(result, end_s, 0.6, [](double) { return 0.0; }), 0.005)
            << from << " to " << to << " at " << share;
      }
    }
  }
}

TEST(Resample, GoesThroughEveryFrameUpwards) {
  std::mt19937 random(7);
  std::normal_distribution<double> value(0.0, 10.0);
  const CoefficientMotion motion = sampled(60.0, 3.0, [&](double) { return value(random); });
  const CoefficientMotion result = resample_motion(motion, 240.0, 3.0);
  for (Eigen::Index k = 0; k < motion.coefficients.rows(); ++k) {
    EXPECT_NEAR(result.coefficients(4 * k, 0), motion.coefficients(k, 0), 1e-12);
  }
}

// The same sum written plainly, with the C library's sine and Bessel function.
TEST(Resample, IsTheKaiserWindowedSincSum) {
  std::mt19937 random(8);
  std::normal_distribution<double> value(0.0, 10.0);
  for (const double from : {100.0, 44.1}) {
    const CoefficientMotion motion = sampled(from, 2.0, [&](double) { return value(random); });
    const auto n = motion.coefficients.rows();
    const auto at = [&](Eigen::Index i) {
      return i < 0    ? 2 * motion.coefficients(0, 0) - motion.coefficients(-i, 0)
             : i >= n ? 2 * motion.coefficients(n - 1, 0) - motion.coefficients(2 * (n - 1) - i, 0)
                      : motion.coefficients(i, 0);
    };
    for (const double to : {29.97, 30.0, 120.0}) {
      const CoefficientMotion result = resample_motion(motion, to, 2.0);
      const double band = std::min(1.0, to / from);
      for (Eigen::Index k = 0; k < result.coefficients.rows(); ++k) {
        const double u = std::min(static_cast<double>(k) * from / to, static_cast<double>(n - 1));
        double sum = 0.0;
        double weights = 0.0;
        for (Eigen::Index i = -60; i < n + 60; ++i) {
          const double x = band * (static_cast<double>(i) - u);
          if (std::abs(x) < 6.0) {
            const double sinc = x == 0.0 ? 1.0 : std::sin(kPi * x) / (kPi * x);
            const double window = std::cyl_bessel_i(0.0, 5.0 * std::sqrt(1.0 - x * x / 36.0));
            sum += sinc * window * at(i);
            weights += sinc * window;
          }
        }
        ASSERT_NEAR(result.coefficients(k, 0), sum / weights, 1e-10)
            << from << " " << to << " " << k;
      }
    }
  }
}

TEST(Resample, IsMirroredWhereTheMotionIs) {
  std::mt19937 random(9);
  std::normal_distribution<double> value(0.0, 10.0);
  const CoefficientMotion motion = sampled(100.0, 2.0, [&](double) { return value(random); });
  CoefficientMotion mirrored = motion;
  mirrored.coefficients = motion.coefficients.colwise().reverse().eval();
  const FrameMatrixD forth = resample_motion(motion, 30.0, 2.0).coefficients;
  const FrameMatrixD back = resample_motion(mirrored, 30.0, 2.0).coefficients;
  EXPECT_LT((forth - back.colwise().reverse()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Resample, TakesMotionsOfAFewFrames) {
  for (int frames = 1; frames <= 40; ++frames) {
    const double end_s = (frames - 1) / 100.0;
    const CoefficientMotion motion =
        sampled(100.0, end_s, [](double t) { return std::cos(40 * t); });
    for (const double to : kRates) {
      const CoefficientMotion result = resample_motion(motion, to, end_s);
      EXPECT_EQ(result.coefficients.rows(), frame_count_to(end_s, to));
      EXPECT_LT(result.coefficients.cwiseAbs().maxCoeff(), 2.0);
      EXPECT_NEAR(result.coefficients(0, 0), 1.0, 0.05);
    }
  }
}

TEST(Resample, HoldsTheLastFrameBeyondIt) {
  const CoefficientMotion motion = sampled(100.0, 0.5, [](double t) { return t; });
  for (const double to : {30.0, 100.0, 240.0}) {
    const CoefficientMotion result = resample_motion(motion, to, 1.0);
    EXPECT_EQ(result.coefficients.rows(), static_cast<Eigen::Index>(to) + 1);
    EXPECT_NEAR(result.coefficients(result.coefficients.rows() - 1, 0), 0.5, 1e-12);
  }
}

TEST(Resample, TakesHeadPosesAlong) {
  CoefficientMotion motion = sampled(100.0, 2.0, [](double) { return 0.0; });
  for (Eigen::Index k = 0; k < motion.coefficients.rows(); ++k) {
    const double t = static_cast<double>(k) / 100.0;
    HeadPose pose;
    pose.translation_mm = Eigen::Vector3d(t, -t, 5.0);
    pose.rotation = Eigen::AngleAxisd(0.2 * t, Eigen::Vector3d::UnitY());
    if (k % 3 == 0) {
      pose.rotation.coeffs() *= -1.0; // the same rotation
    }
    motion.head.push_back(pose);
  }
  const CoefficientMotion result = resample_motion(motion, 30.0, 2.0);
  ASSERT_EQ(result.head.size(), 61U);
  for (std::size_t k = 0; k < result.head.size(); ++k) {
    const double t = static_cast<double>(k) / 30.0;
    const Eigen::Quaterniond rotation(Eigen::AngleAxisd(0.2 * t, Eigen::Vector3d::UnitY()));
    EXPECT_LT(result.head[k].rotation.angularDistance(rotation), 1e-4);
    EXPECT_LT((result.head[k].translation_mm - Eigen::Vector3d(t, -t, 5.0)).norm(), 1e-3);
    EXPECT_NEAR(result.head[k].rotation.norm(), 1.0, 1e-15);
  }
  EXPECT_EQ(resample_motion(motion, 100.0, 2.0).head.size(), motion.head.size());
}

TEST(Resample, RefusesWhatCannotBe) {
  const CoefficientMotion motion = sampled(100.0, 1.0, [](double t) { return t; });
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(resample_motion({}, 30.0, 1.0), InternalError);
  for (const double fps : {0.0, -30.0, nan, infinity}) {
    EXPECT_THROW(resample_motion(motion, fps, 1.0), InternalError);
  }
  for (const double end_s : {-1.0, nan, infinity}) {
    EXPECT_THROW(resample_motion(motion, 30.0, end_s), InternalError);
  }
  CoefficientMotion headless = motion;
  headless.head.resize(3);
  EXPECT_THROW(resample_motion(headless, 30.0, 1.0), InternalError);
}

} // namespace
} // namespace phonomime
