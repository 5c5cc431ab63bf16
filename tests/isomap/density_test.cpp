// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/density.h"
#include "isomap/palette.h"
#include "tests/isomap/point_sets.h"
#include "tests/support/expect_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr Colour kBlack = {0.0, 0.0, 0.0};
constexpr Colour kRed = {1.0, 0.0, 0.0};
constexpr Colour kBlue = {0.0, 0.0, 1.0};

std::array<int, 3> pixel(const Raster& raster, int x, int y) {
  const auto at = static_cast<std::size_t>(3 * (y * raster.width_px + x));
  return {raster.bytes[at], raster.bytes[at + 1], raster.bytes[at + 2]};
}

TEST(MapView, KeepsAllPlacesInsideWithOneScale) {
  MapPlaces places(3, 2);
  places << -1.0, 5.0, 3.0, 6.0, 1.0, 5.5;
  const MapView view(places, 200, 100, 10.0);
  EXPECT_EQ(view.px_per_unit(), 45.0);
  EXPECT_EQ(view.to_px(-1.0, 5.5), Eigen::Vector2d(10.0, 50.0));
  EXPECT_EQ(view.to_px(3.0, 5.5), Eigen::Vector2d(190.0, 50.0));
  EXPECT_LT(view.to_px(1.0, 6.0).y(), view.to_px(1.0, 5.0).y()) << "y goes up";
  const Eigen::Vector2d back = view.to_map(37.0, 81.0);
  EXPECT_LT((view.to_px(back.x(), back.y()) - Eigen::Vector2d(37.0, 81.0)).norm(), 1e-12);
  EXPECT_EQ(MapView(MapPlaces(MapPlaces::Zero(2, 2)), 200, 100, 10.0).to_px(0.0, 0.0),
            Eigen::Vector2d(100.0, 50.0));
  EXPECT_EQ(MapView(MapPlaces(0, 2), 200, 100, 10.0).to_px(0.0, 0.0), Eigen::Vector2d(100.0, 50.0));
}

// E3 at every pixel by its sum over every frame.
TEST(Density, EqualsThePlainSumOfE3) {
  std::mt19937 random(91);
  const MapPlaces places = test::uniform_points(random, 60, 2).cast<double>();
  std::vector<std::int32_t> emotion_of;
  for (int i = 0; i < 60; ++i) {
    emotion_of.push_back(i % 3);
  }
  const std::vector<Colour> palette = {kBlack, kRed, {0.2, 0.6, 0.4}};
  const MapView view(places, 90, 70, 12.0);
  const DensityOptions options = {.sigma_px = 5.0, .rho = 0.35, .threads = 1};
  const Raster raster = draw_density(places, emotion_of, palette, view, options);
  ASSERT_EQ(raster.bytes.size(), 90U * 70U * 3U);
  int clamped = 0;
  for (int y = 0; y < 70; ++y) {
    for (int x = 0; x < 90; ++x) {
      double sum = 0.0;
      Eigen::Vector3d colour = Eigen::Vector3d::Zero();
      for (Eigen::Index i = 0; i < 60; ++i) {
        const double d_sq =
            (view.to_px(places(i, 0), places(i, 1)) - Eigen::Vector2d(x + 0.5, y + 0.5))
                .squaredNorm();
        const double density = 0.35 * std::exp(-d_sq / (2.0 * 25.0));
        const Colour& of =
            palette[static_cast<std::size_t>(emotion_of[static_cast<std::size_t>(i)])];
        sum += density;
        colour += density * Eigen::Vector3d(of.red, of.green, of.blue);
      }
      const double ink = std::min(1.0, sum);
      clamped += sum > 1.0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = (1.0 - ink) + ink * colour[static_cast<Eigen::Index>(c)] / sum;
        // The end of each Gaussian at 4 sigma takes off up to 0.03 % of it.
        ASSERT_NEAR(pixel(raster, x, y)[c], value * 255.0, 1.0) << x << " " << y;
      }
    }
  }
  EXPECT_GT(clamped, 50);
  DensityOptions by_two = options;
  by_two.threads = 2;
  EXPECT_EQ(draw_density(places, emotion_of, palette, view, by_two).bytes, raster.bytes);
}

TEST(Density, OfOneFrame) {
  MapPlaces place(1, 2);
  place << 3.0, 4.0;
  const std::vector<std::int32_t> emotion = {0};
  const std::vector<Colour> palette = {kBlue};
  const MapView view(place, 101, 101, 10.0);
  const Raster raster =
      draw_density(place, emotion, palette, view, {.sigma_px = 8.0, .rho = 0.999});
  EXPECT_EQ(pixel(raster, 50, 50), (std::array<int, 3>{0, 0, 255}));
  const int at_sigma = static_cast<int>(std::lround(255.0 * (1.0 - 0.999 * std::exp(-0.5))));
  EXPECT_EQ(pixel(raster, 58, 50), (std::array<int, 3>{at_sigma, at_sigma, 255}));
  EXPECT_EQ(pixel(raster, 50, 42), (std::array<int, 3>{at_sigma, at_sigma, 255}));
  EXPECT_EQ(pixel(raster, 5, 5), (std::array<int, 3>{255, 255, 255}));
}

TEST(Density, ByDefaultLeavesRoomAtTheMedianFrame) {
  std::mt19937 random(92);
  for (const int count : {1, 50, 3000}) {
    const MapPlaces places = test::uniform_points(random, count, 2).cast<double>();
    const std::vector<std::int32_t> emotion_of(static_cast<std::size_t>(count), 0);
    const std::vector<Colour> palette = {kBlack};
    const MapView view(places, 300, 300, 30.0);
    const Raster raster = draw_density(places, emotion_of, palette, view);
    std::vector<int> ink;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Vector2d at = view.to_px(places(i, 0), places(i, 1));
      ink.push_back(255 - pixel(raster, static_cast<int>(at.x()), static_cast<int>(at.y()))[0]);
    }
    std::nth_element(ink.begin(), ink.begin() + count / 2, ink.end());
    EXPECT_NEAR(ink[static_cast<std::size_t>(count / 2)], 255 * kUsualInk, 2);
  }
}

TEST(Density, RefusesSizesThatDoNotFit) {
  const std::vector<Colour> palette = {kBlack};
  const MapPlaces places = MapPlaces::Zero(2, 2);
  const MapView view(places, 64, 64, 4.0);
  const std::vector<std::int32_t> one = {0}, unknown = {0, 1}, negative = {0, -1};
  EXPECT_THROW(draw_density(places, one, palette, view), InternalError);
  EXPECT_THROW(draw_density(places, unknown, palette, view), InternalError);
  EXPECT_THROW(draw_density(places, negative, palette, view), InternalError);
}

TEST(Palette, IsThePapersUnlessChosen) {
  const std::vector<std::string> emotions = {"anger",   "disgust", "happiness",
                                             "neutral", "sadness", "surprise"};
  const std::vector<Colour> palette = palette_for(emotions, {{"sadness", kRed}});
  EXPECT_EQ(palette[3], kBlack);
  EXPECT_GT(palette[0].red, palette[0].green + palette[0].blue);
  EXPECT_GT(palette[2].blue, palette[2].red + palette[2].green);
  EXPECT_EQ(palette[4], kRed);
  const Colour green = palette_for(emotions)[4];
  EXPECT_GT(green.green, green.red + green.blue);
  for (std::size_t a = 0; a < palette.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_FALSE(palette[a] == palette[b]) << a << " " << b;
    }
  }
}

TEST(Palette, ReadsColours) {
  EXPECT_EQ(parse_colour("#ff0000", "x"), kRed);
  EXPECT_EQ(format_colour(parse_colour("#1a2B3c", "x")), "#1a2b3c");
  for (const char* wrong : {"", "ff0000", "#ff000", "#ff00000", "#gg0000", "red"}) {
    test::expect_error([&] { parse_colour(wrong, "--palette"); }, "--palette: this is no colour");
  }
}

} // namespace
} // namespace phonomime
