// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/motion_database.h"
#include "tests/db/store/made_corpus.h"
#include "tests/db/store/raw_database.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::raw_query;

StoredMap made_map(const std::string& phoneme, int placed = 3) {
  StoredMap map;
  map.record = {.speaker = "s1",
                .phoneme = phoneme,
                .made_of = "these frames",
                .neighbours = 12,
                .keep_largest = true,
                .largest_exact = 5000,
                .landmark_count = 500,
                .seed = 0xffffffffffffffff,
                .nodes = 2,
                .frames = placed + 4,
                .components = 3,
                .landmarks = 0,
                .far_frames = 1,
                .isomap_residual_variance = 0.125,
                .pca_residual_variance = 0.25,
                .placed = placed};
  map.isomap = StoredMap::Places::Random(placed, 2);
  map.pca = StoredMap::Places::Random(placed, 2);
  for (int i = 0; i < placed; ++i) {
    map.kept.push_back(i + 2);
  }
  return map;
}

struct PhonemeMapsTest : ::testing::Test {
  test::TemporaryFolder folder;
  std::filesystem::path path = folder / "motion.db";

  PhonemeMapsTest() {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    import_corpus(database, test::made_corpus("a", 2));
  }
  MotionDatabase open(OpenMode mode = OpenMode::read_only) const {
    return MotionDatabase::open(path, mode);
  }
};

void expect_same(const StoredMap& a, const StoredMap& b) {
  EXPECT_EQ(a.record.speaker, b.record.speaker);
  EXPECT_EQ(a.record.phoneme, b.record.phoneme);
  EXPECT_EQ(a.record.made_of, b.record.made_of);
  EXPECT_EQ(a.record.neighbours, b.record.neighbours);
  EXPECT_EQ(a.record.keep_largest, b.record.keep_largest);
  EXPECT_EQ(a.record.largest_exact, b.record.largest_exact);
  EXPECT_EQ(a.record.landmark_count, b.record.landmark_count);
  EXPECT_EQ(a.record.seed, b.record.seed);
  EXPECT_EQ(a.record.nodes, b.record.nodes);
  EXPECT_EQ(a.record.frames, b.record.frames);
  EXPECT_EQ(a.record.components, b.record.components);
  EXPECT_EQ(a.record.landmarks, b.record.landmarks);
  EXPECT_EQ(a.record.far_frames, b.record.far_frames);
  EXPECT_EQ(a.record.isomap_residual_variance, b.record.isomap_residual_variance);
  EXPECT_EQ(a.record.pca_residual_variance, b.record.pca_residual_variance);
  EXPECT_EQ(a.record.placed, b.record.placed);
  EXPECT_EQ(a.kept, b.kept);
  EXPECT_EQ(a.isomap, b.isomap);
  EXPECT_EQ(a.pca, b.pca);
}

TEST_F(PhonemeMapsTest, WhatWasSavedIsReadBack) {
  const StoredMap first = made_map("aa"), second = made_map("b", 7);
  open(OpenMode::read_write).save_map(second);
  open(OpenMode::read_write).save_map(first);
  const MotionDatabase database = open();
  expect_same(*database.load_map("s1", "aa"), first);
  expect_same(*database.load_map("s1", "b"), second);
  EXPECT_FALSE(database.load_map("s1", "m"));
  EXPECT_FALSE(database.load_map("nobody", "aa"));
  const std::vector<StoredMapRecord> records = database.list_maps("s1");
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[0].phoneme, "aa");
  EXPECT_EQ(records[1].placed, 7);
  EXPECT_TRUE(database.list_maps("nobody").empty());
  test::expect_sound(path);
  test::expect_alone_and_whole(path);
}

TEST_F(PhonemeMapsTest, AMapTakesThePlaceOfTheOneBefore) {
  open(OpenMode::read_write).save_map(made_map("aa"));
  StoredMap newer = made_map("aa", 9);
  newer.record.made_of = "other frames";
  open(OpenMode::read_write).save_map(newer);
  expect_same(*open().load_map("s1", "aa"), newer);
  EXPECT_EQ(open().list_maps("s1").size(), 1u);
}

// That they are stale now is for `made_of` to say.
TEST_F(PhonemeMapsTest, AnImportLeavesMaps) {
  const StoredMap map = made_map("aa");
  MotionDatabase database = open(OpenMode::read_write);
  database.save_map(map);
  import_corpus(database, test::made_corpus("other", 2));
  expect_same(*database.load_map("s1", "aa"), map);
}

TEST_F(PhonemeMapsTest, PartsThatDoNotFitAreRefused) {
  MotionDatabase database = open(OpenMode::read_write);
  StoredMap map = made_map("aa");
  map.kept.pop_back();
  EXPECT_THROW(database.save_map(map), InternalError);
  map = made_map("aa");
  map.pca.conservativeResize(2, 2);
  EXPECT_THROW(database.save_map(map), InternalError);
  map = made_map("aa");
  map.isomap(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(database.save_map(map), InternalError);
  EXPECT_THROW(database.save_map(made_map("no such phoneme")), InternalError);
  EXPECT_TRUE(database.list_maps("s1").empty());
}

TEST_F(PhonemeMapsTest, ADatabaseOpenedForReadingTakesNone) {
  MotionDatabase database = open();
  EXPECT_THROW(database.save_map(made_map("aa")), InternalError);
}

TEST_F(PhonemeMapsTest, DamagedMapsAreRefused) {
  const std::vector<std::string> damages = {
      "UPDATE phoneme_maps SET isomap = x'0011'",
      "UPDATE phoneme_maps SET pca = zeroblob(16)",
      "UPDATE phoneme_maps SET kept = zeroblob(12)",                      // not ascending
      "UPDATE phoneme_maps SET kept = x'ffffffff0000000001000000'",       // before the first
      "UPDATE phoneme_maps SET kept = x'0000000001000000ffffff7f'",       // after the last
      "UPDATE phoneme_maps SET frames = 9000000000, placed = 8999999999", // more than fit
      "UPDATE phoneme_maps SET isomap = x'" + std::string(96, 'f') + "'", // NaN
      "UPDATE phoneme_maps SET isomap_residual_variance = 9e999",         // infinite
      "UPDATE phoneme_maps SET pca_residual_variance = -0.5"};
  for (const std::string& damage : damages) {
    SCOPED_TRACE(damage);
    open(OpenMode::read_write).save_map(made_map("aa"));
    raw_query(path, damage);
    test::expect_error([&] { open().load_map("s1", "aa"); }, "damaged");
  }
}

} // namespace
} // namespace phonomime
