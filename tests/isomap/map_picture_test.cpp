// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/file_io.h"
#include "isomap/map_picture.h"
#include "tests/isomap/point_sets.h"
#include "tests/support/expect_error.h"

#include <filesystem>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

// Two emotions apart from each other, and one of each role and mark. read_pictures.py knows what
// should be where.
MapPicture some_picture() {
  MapPicture picture;
  picture.title = "/w/ <b> & \"c\"";
  picture.emotions = {"anger", "neutral"};
  picture.palette = palette_for(picture.emotions);
  picture.places.resize(40, 2);
  for (Eigen::Index i = 0; i < 40; ++i) {
    const double t = static_cast<double>(i % 20) / 19.0;
    picture.places.row(i) << (i < 20 ? 0.0 : 10.0), 6.0 * t;
    picture.emotion_of.push_back(i < 20 ? 0 : 1);
  }
  const auto across = [](double y) {
    MapPlaces places(3, 2);
    places << 3.0, y, 5.0, y, 7.0, y;
    return places;
  };
  picture.trajectories = {{across(1.0), 0, TrajectoryRole::node},
                          {across(2.0), 1, TrajectoryRole::pruned},
                          {across(3.0), 0, TrajectoryRole::suspect},
                          {across(4.0), 1, TrajectoryRole::context_correct},
                          {across(5.0), 0, TrajectoryRole::chosen}};
  picture.marks = {{1.5, 1.0, MarkRole::time_correct},
                   {1.5, 2.0, MarkRole::context_correct},
                   {1.5, 3.0, MarkRole::chosen},
                   {1.5, 4.0, MarkRole::picked}};
  return picture;
}

MapPictureOptions small() {
  return {.width_px = 600, .height_px = 400, .density = {.sigma_px = 6.0, .threads = 1}};
}

TEST(MapPicture, IsTheSameTwiceAndForTwoThreads) {
  const MapPicture picture = some_picture();
  MapPictureOptions by_two = small();
  by_two.density.threads = 2;
  const std::string png = draw_png(picture, small());
  const std::string svg = draw_svg(picture, small());
  EXPECT_EQ(png, draw_png(picture, by_two));
  EXPECT_EQ(svg, draw_svg(picture, by_two));
  EXPECT_NE(png, draw_png(picture, {}));
}

TEST(MapPicture, IsLeftForAnotherReader) { // read_pictures.py
  const std::filesystem::path folder = PHONOMIME_PICTURE_FOLDER;
  MapPictureOptions plain = small();
  plain.legend = false;
  write_file(folder / "map.png", draw_png(some_picture(), small()));
  write_file(folder / "map.svg", draw_svg(some_picture(), small()));
  write_file(folder / "plain.png", draw_png(some_picture(), plain));
  const MapPictureView view = view_of(some_picture(), small());
  std::string places; // name, x, y in pixels
  const auto tell = [&](const std::string& name, double x, double y) {
    const Eigen::Vector2d px = view.map.to_px(x, y);
    places +=
        name + "\t" + std::to_string(px.x()) + "\t" + std::to_string(px.y() + view.top_px) + "\n";
  };
  tell("anger", 0.0, 3.0);
  tell("neutral", 10.0, 3.0);
  tell("nothing", 1.5, 5.5);
  tell("node", 4.0, 1.0);
  tell("suspect", 4.0, 3.0);
  tell("context_correct", 4.0, 4.0);
  tell("chosen", 4.0, 5.0);
  tell("chosen_end", 7.0, 5.0);
  tell("time_correct_mark", 1.5, 1.0);
  tell("context_correct_mark", 1.5, 2.0);
  tell("chosen_mark", 1.5, 3.0);
  tell("picked_mark", 1.5, 4.0);
  write_file(folder / "places.tsv", places);
}

TEST(MapPicture, OfAnEmptyMapIsWhite) {
  const MapPicture nothing;
  EXPECT_GT(draw_png(nothing).size(), 100U);
  EXPECT_NE(draw_svg(nothing).find("</svg>"), std::string::npos);
}

TEST(MapPicture, OfATrajectoryThatStandsStillHasNoArrow) {
  MapPicture picture = some_picture();
  picture.marks.clear();
  picture.trajectories = {{MapPlaces::Constant(5, 2, 3.0), 0, TrajectoryRole::chosen},
                          {MapPlaces(0, 2), 0, TrajectoryRole::chosen}};
  const std::string svg = draw_svg(picture, small());
  const std::size_t layer = svg.find("<g id=\"chosen\">");
  ASSERT_NE(layer, std::string::npos);
  EXPECT_EQ(svg.substr(layer, svg.find("</g>", layer) - layer).find("Z\""), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(MapPicture, RefusesOptionsOutOfRange) {
  const MapPicture picture = some_picture();
  test::expect_error([&] { draw_png(picture, {.width_px = 10}); },
                     "width_px is out of range (expected 64 to 8192, got 10)");
  test::expect_error([&] { draw_svg(picture, {.height_px = 9000}); }, "height_px");
  test::expect_error([&] { draw_svg(picture, {.density = {.sigma_px = 0.0}}); }, "sigma_px");
  test::expect_error([&] { draw_svg(picture, {.density = {.rho = 1.0}}); }, "rho");
  test::expect_error([&] { draw_svg(picture, {.density = {.rho = -0.1}}); }, "rho");
  MapPicture without_palette = picture;
  without_palette.palette.pop_back();
  EXPECT_THROW(draw_png(without_palette), InternalError);
  MapPicture unknown_emotion = picture;
  unknown_emotion.trajectories[0].emotion = 2;
  EXPECT_THROW(draw_png(unknown_emotion), InternalError);
}

} // namespace
} // namespace phonomime
