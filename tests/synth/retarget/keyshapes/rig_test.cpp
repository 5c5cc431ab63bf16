// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/rig.h"

#include "db/types/file_io.h"
#include "synth/retarget/keyshapes/rig_consistency.h"
#include "synth/retarget/keyshapes/rig_motion.h"
#include "tests/support/expect_error.h"

#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

Layout four_markers() {
  Layout layout;
  layout.groups = {{"lip", {Region::lips}},
                   {"chin", {Region::jaw}},
                   {"brow_r", {Region::brows}},
                   {"brow_l", {Region::brows}}};
  return layout;
}

// Keyshapes of weights of one target shape each, named after it.
RigSet made_set(const std::string& expression, const std::string& part, int first, int count) {
  RigSet set{expression, part, {}};
  for (int i = 0; i < count; ++i) {
    RigKeyshape keyshape;
    keyshape.name = "k" + std::to_string(first + i);
    keyshape.source = first + i;
    keyshape.weights["w" + std::to_string(first + i)] = 1.0;
    set.keyshapes.push_back(keyshape);
  }
  return set;
}

FrameMatrixD normal(std::uint64_t seed, Eigen::Index rows, Eigen::Index columns) {
  std::mt19937_64 draw(seed);
  std::normal_distribution<double> number;
  return FrameMatrixD::NullaryExpr(rows, columns, [&] { return number(draw); });
}

TEST(Rig, TheExampleOfItsPageIsRead) {
  const std::string page =
      read_file(std::filesystem::path(PHONOMIME_SOURCE_DIR) / "corpora_schema/rig.md");
  const std::size_t start = page.find("```rig\n") + 7;
  const Rig rig = parse_rig(page.substr(start, page.find("```", start) - start), "rig.md");
  EXPECT_EQ(rig.target, RigTarget::joints);
  ASSERT_EQ(rig.sets.size(), 1u);
  ASSERT_EQ(rig.sets[0].keyshapes.size(), 2u);
  EXPECT_EQ(rig.sets[0].keyshapes[1].source, 3);
  EXPECT_NEAR(rig.sets[0].keyshapes[0].rotations.at("jaw").x(),
              std::sin(7.5 * std::numbers::pi / 180.0), 1e-6);
  EXPECT_EQ(format_rig(parse_rig(format_rig(rig), "again")), format_rig(rig));
}

TEST(Rig, SaysWhatIsWrong) {
  const std::string head = R"({"rig":1,"target":"shapes","source":"k.csv","sets":[{"keyshapes":[)";
  const auto error_of = [&](const std::string& keyshapes, const std::string& part) {
    test::expect_error([&] { parse_rig(head + keyshapes + "]}]}", "my.rig"); }, part);
  };
  error_of(R"({"name":"a","source":0,"file":"a.obj"})",
           R"(my.rig: keyshape "a" does not say what the shapes of the target do)");
  error_of(R"({"name":"a","source":0,"weights":{}},{"name":"a","source":1,"weights":{}})",
           R"(has two keyshapes "a")");
  error_of(R"({"name":"a","source":-1,"weights":{}})", "my.rig");
  test::expect_error(
      [] {
        parse_rig(R"({"rig":1,"target":"joints","file":"x.glb","source":"k.csv","sets":
                  [{"keyshapes":[{"name":"a","source":0,"rotations":{"jaw":[0,0,0,2]}}]}]})",
                  "my.rig");
      },
      R"(the rotation of "jaw" is no unit quaternion)");
  test::expect_error(
      [] {
        parse_rig(R"({"rig":1,"target":"mesh","source":"k.csv","sets":
                  [{"keyshapes":[{"name":"a","source":0,"file":"a.obj"}]}]})",
                  "my.rig");
      },
      "names no file of its target");
}

TEST(Rig, PartsAreSolvedApart) {
  const Layout layout = four_markers();
  const FrameMatrixD source = normal(1, 4, 12);
  Rig rig{.source = "k.csv",
          .sets = {made_set("neutral", "lower", 0, 2), made_set("neutral", "upper", 2, 2)}};
  const FrameMatrixD below = normal(2, 30, 2).cwiseAbs() * 0.3;
  const FrameMatrixD above = normal(3, 30, 2).cwiseAbs() * 0.3;
  FrameMatrixD frames(30, 12);
  frames.leftCols(6) = below * source.topRows(2).leftCols(6);
  frames.rightCols(6) = above * source.bottomRows(2).rightCols(6);
  const FrameMatrixD weights =
      rig_weights(rig, layout, source, frames, FrameMatrixD::Ones(30, 1), {.upper = 5.0});
  EXPECT_LT((weights.leftCols(2) - below).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((weights.rightCols(2) - above).cwiseAbs().maxCoeff(), 1e-10);
  const RigTargets targets = shape_targets(rig);
  EXPECT_EQ(targets.names, (std::vector<std::string>{"w0", "w1", "w2", "w3"}));
  EXPECT_EQ(targets.motion(weights), weights);
  rig.sets[0].keyshapes[1].source = 4;
  test::expect_error(
      [&] { rig_weights(rig, layout, source, frames, FrameMatrixD::Ones(30, 1), {}); },
      R"(k.csv: keyshape "k1" is a row that the file has not (expected 0 to 3, got 4))");
}

// T5.1.
TEST(Rig, ExpressionsAreBlendedByTheEmotionTrack) {
  const Rig rig{.source = "k.csv",
                .sets = {made_set("neutral", "face", 0, 2), made_set("anger", "face", 2, 2)}};
  const EmotionTrack track = parse_emotion_track("1 2 anger 0.4\n", "track");
  const FrameMatrixD shares = expression_shares(rig, track, {{"neutral", 1.0}}, 50.0, 200, 0.02);
  EXPECT_NEAR(shares(20, 0), 1.0, 1e-12);
  EXPECT_NEAR(shares(75, 0), 0.6, 1e-12);
  EXPECT_NEAR(shares(75, 1), 0.4, 1e-12);
  EXPECT_NEAR(shares(50, 1), 0.2, 0.1); // gliding
  const FrameMatrixD source = normal(5, 4, 12);
  const FrameMatrixD frames = normal(6, 200, 12);
  const FrameMatrixD blended = rig_weights(rig, four_markers(), source, frames, shares, {});
  const Rig calm{.source = "k.csv", .sets = {rig.sets[0]}};
  const FrameMatrixD alone =
      rig_weights(calm, four_markers(), source, frames, FrameMatrixD::Ones(200, 1), {});
  EXPECT_LT((blended.row(75).head(2) - 0.6 * alone.row(75)).cwiseAbs().maxCoeff(), 1e-12);
  test::expect_error(
      [&] {
        expression_shares(rig, {}, {{"angr", 1.0}}, 50.0, 10);
      },
      R"(no keyshapes of the expression "angr" (expected neutral, anger). Did you mean "anger"?)");
  EXPECT_EQ(expression_shares(calm, track, {{"neutral", 1.0}}, 50.0, 10),
            FrameMatrixD::Ones(10, 1));
  Rig mixed = rig;
  mixed.sets.push_back(made_set("happiness", "face", 0, 2));
  const EmotionMixture mixture = parse_emotion_mixture("anger:0.5+happiness:0.3", "--emotion");
  EXPECT_LT(
      (expression_shares(mixed, {}, mixture, 50.0, 10).row(5) - Eigen::RowVector3d(0.2, 0.5, 0.3))
          .norm(),
      1e-12);
}

TEST(Rig, ContraryChangesArePointedOut) {
  const Layout layout = four_markers();
  // Brows up, lips open, both; and brows further up.
  FrameMatrixD source = FrameMatrixD::Zero(4, 12);
  source(0, 7) = source(0, 10) = 3.0;
  source(1, 1) = 8.0;
  source(2, 7) = source(2, 10) = 3.0;
  source(2, 1) = 8.0;
  source(3, 7) = source(3, 10) = 5.0;
  Rig rig{.source = "k.csv", .sets = {{"neutral", "face", {}}}};
  const auto add = [&](const std::string& name, double ears, double beak) {
    RigKeyshape keyshape;
    keyshape.name = name;
    keyshape.source = static_cast<int>(rig.sets[0].keyshapes.size());
    keyshape.weights = {{"beak", beak}, {"ears", ears}};
    rig.sets[0].keyshapes.push_back(keyshape);
  };
  add("brows", 0.5, 0.0);
  add("open", 0.0, 1.0);
  add("both", 0.6, 0.9); // an artist's freedom
  add("high", 0.9, 0.0);
  EXPECT_TRUE(find_conflicts(rig, layout, source, shape_targets(rig)).empty());
  rig.sets[0].keyshapes[2].weights["ears"] = -0.6; // brows up is ears down here
  const std::vector<RigConflict> conflicts =
      find_conflicts(rig, layout, source, shape_targets(rig));
  ASSERT_FALSE(conflicts.empty());
  for (const RigConflict& conflict : conflicts) {
    EXPECT_EQ(conflict.value, "ears");
    EXPECT_GE(conflict.source_likeness, 0.9);
    EXPECT_LT(conflict.target_likeness, -0.25);
    EXPECT_TRUE(conflict.from == "both" || conflict.to == "both" || conflict.other_from == "both" ||
                conflict.other_to == "both");
  }
  EXPECT_EQ(find_conflicts(rig, layout, source, shape_targets(rig), 1).size(), 1u);
}

} // namespace
} // namespace phonomime
