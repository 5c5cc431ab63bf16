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

StoredStyleModel made_model(const std::string& made_of = "these sentences") {
  StoredStyleModel model{.speaker = "s1", .made_of = made_of, .trained_json = R"({"a": "\u00e4"})"};
  model.matrices["bases"] = Eigen::MatrixXd::Random(12, 5);
  model.matrices["mean"] = Eigen::MatrixXd::Random(5, 1);
  return model;
}

void expect_same(const StoredStyleModel& a, const StoredStyleModel& b) {
  EXPECT_EQ(a.speaker, b.speaker);
  EXPECT_EQ(a.made_of, b.made_of);
  EXPECT_EQ(a.trained_json, b.trained_json);
  EXPECT_EQ(a.matrices, b.matrices);
}

struct StyleModelsTest : ::testing::Test {
  test::TemporaryFolder folder;
  std::filesystem::path path = folder / "motion.db";

  StyleModelsTest() {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    import_corpus(database, test::made_corpus("a", 2));
  }
  MotionDatabase open(OpenMode mode = OpenMode::read_only) const {
    return MotionDatabase::open(path, mode);
  }
};

TEST_F(StyleModelsTest, WhatWasSavedIsReadBack) {
  EXPECT_FALSE(open().load_style_model("s1"));
  const StoredStyleModel model = made_model();
  open(OpenMode::read_write).save_style_model(model);
  expect_same(*open().load_style_model("s1"), model);
  EXPECT_FALSE(open().load_style_model("nobody"));
  // The matrix as others read it: one column after the other, little-endian.
  EXPECT_EQ(raw_query(path, "SELECT row_count, column_count, length(numbers) FROM style_matrices "
                            "WHERE name = 'bases'"),
            raw_query(path, "SELECT 12, 5, 480"));
  test::expect_sound(path);
  test::expect_alone_and_whole(path);
}

TEST_F(StyleModelsTest, AModelTakesThePlaceOfTheOneBeforeWithAllItsMatrices) {
  open(OpenMode::read_write).save_style_model(made_model());
  StoredStyleModel newer = made_model("other sentences");
  newer.matrices.erase("mean");
  newer.matrices["other"] = Eigen::MatrixXd::Random(2, 3);
  open(OpenMode::read_write).save_style_model(newer);
  expect_same(*open().load_style_model("s1"), newer);
  EXPECT_EQ(raw_query(path, "SELECT count(*) FROM style_matrices"), std::vector<std::string>{"2"});
  test::expect_sound(path);
}

// That it is stale now is for `made_of` to say.
TEST_F(StyleModelsTest, AnImportLeavesModels) {
  const StoredStyleModel model = made_model();
  MotionDatabase database = open(OpenMode::read_write);
  database.save_style_model(model);
  import_corpus(database, test::made_corpus("other", 2));
  expect_same(*database.load_style_model("s1"), model);
}

TEST_F(StyleModelsTest, WhatCannotBeKeptIsRefused) {
  MotionDatabase database = open(OpenMode::read_write);
  StoredStyleModel model = made_model();
  model.matrices["bases"](1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(database.save_style_model(model), InternalError);
  model = made_model();
  model.matrices["empty"] = Eigen::MatrixXd(0, 3);
  EXPECT_THROW(database.save_style_model(model), InternalError);
  model = made_model();
  model.speaker = "nobody";
  EXPECT_THROW(database.save_style_model(model), InternalError);
  EXPECT_THROW(open().save_style_model(made_model()), InternalError);
  EXPECT_FALSE(database.load_style_model("s1"));
}

TEST_F(StyleModelsTest, DamagedModelsAreRefused) {
  const std::vector<std::string> damages = {
      "UPDATE style_matrices SET numbers = x'0011'",
      "UPDATE style_matrices SET numbers = zeroblob(16)",
      "UPDATE style_matrices SET row_count = 9000000000", // more than there is
      "UPDATE style_matrices SET row_count = 4000000000, column_count = 4000000000", // overflows
      "UPDATE style_matrices SET numbers = x'" + std::string(960, 'f') + "' WHERE name = 'bases'"};
  for (const std::string& damage : damages) {
    SCOPED_TRACE(damage);
    open(OpenMode::read_write).save_style_model(made_model());
    raw_query(path, damage);
    test::expect_error([&] { open().load_style_model("s1"); }, "damaged");
  }
}

} // namespace
} // namespace phonomime
