// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/fingerprint.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "tests/support/temporary_folder.h"

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

namespace fs = std::filesystem;

MotionTable some_table() {
  MotionTable table;
  table.layout.groups = {{.name = "m0", .regions = {Region::lips}}};
  table.pca = {.mean = Eigen::VectorXd::Ones(3),
               .basis = Eigen::MatrixXd::Identity(3, 2),
               .variance = Eigen::VectorXd::Ones(2),
               .total_variance = 2.5};
  table.rate_hz = 100.0;
  table.phonemes = {{"pau", "pau", Visibility::low}, {"p", "p", Visibility::high}};
  table.visemes = {"pau", "p"};
  table.emotions = {"neutral"};
  table.speaker = "ann";
  table.sentences = {{"ann", "neutral", "u1", "Pa"}};
  table.nodes = {{.phoneme = 1, .viseme = 1, .order = 1, .frame_count = 2}};
  table.coefficients = FrameMatrix::Constant(2, 2, 0.5F);
  table.reference_pose = Eigen::VectorXd::Zero(3);
  table.unavailable = {{"ann/neutral/u1#2", "pruned"}};
  table.phoneme_sets = {"arpabet"};
  return table;
}

// Every change gives a fingerprint of its own.
template <typename Value>
void expect_all_differ(const Value& value, const std::vector<std::function<void(Value&)>>& changes,
                       const std::function<std::string(const Value&)>& print) {
  std::set<std::string> seen = {print(value)};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Value changed = value;
    changes[i](changed);
    EXPECT_TRUE(seen.insert(print(changed)).second) << "change " << i;
  }
}

TEST(TableFingerprint, ChangesWithWhateverASynthesisSees) {
  const std::vector<std::function<void(MotionTable&)>> changes = {
      [](MotionTable& t) { t.layout.groups[0].name = "m1"; },
      [](MotionTable& t) { t.layout.groups[0].regions = {Region::jaw}; },
      [](MotionTable& t) { t.pca.mean[1] = 2.0; },
      [](MotionTable& t) { t.pca.basis(2, 1) = 1e-300; },
      [](MotionTable& t) { t.pca.variance[0] = 2.0; }, [](MotionTable& t) { t.rate_hz = 120.0; },
      [](MotionTable& t) { t.phonemes[1].visibility = Visibility::low; },
      [](MotionTable& t) { t.phonemes[1].viseme = "b"; },
      [](MotionTable& t) { t.visemes[1] = "b"; },
      [](MotionTable& t) { t.emotions.push_back("anger"); },
      [](MotionTable& t) { t.speaker = "bob"; }, [](MotionTable& t) { t.sentences[0].id = "u2"; },
      [](MotionTable& t) { t.nodes[0].order = 2; },
      [](MotionTable& t) { t.nodes[0].frame_count = 1; },
      [](MotionTable& t) { t.nodes[0].predecessor = 0; },
      [](MotionTable& t) { t.nodes.push_back(t.nodes[0]); },
      [](MotionTable& t) { t.coefficients(1, 1) = 0.25F; },
      [](MotionTable& t) { t.reference_pose[2] = 1.0; },
      [](MotionTable& t) { t.unavailable.clear(); },
      [](MotionTable& t) { t.phoneme_sets = {"timit"}; },
      [](MotionTable& t) { t.synthetic = true; },
      // The same bytes, cut in another way.
      [](MotionTable& t) {
        t.visemes = {"pa", "up"};
      },
      [](MotionTable& t) { t.coefficients.resize(1, 4), t.coefficients.fill(0.5F); }};
  expect_all_differ<MotionTable>(some_table(), changes,
                                 [](const MotionTable& t) { return fingerprint(t); });
  EXPECT_EQ(fingerprint(some_table()), fingerprint(some_table()));
}

class SynthFingerprintTest : public ::testing::Test {
protected:
  void SetUp() override { fill(folder_.path()); }

  static void fill(const fs::path& folder) {
    for (const char* name : {"a.lab", "track", "constraints", "w.json", "a.wav", "set.json",
                             "face.obj", "markers.tsv"}) {
      write_file(folder / name, name);
    }
  }

  static SynthOptions options(const fs::path& folder) {
    return {.database = folder / "ann.db",
            .transcript = folder / "a.lab",
            .outputs = {folder / "a.csv", folder / "a.glb"},
            .phoneme_set = (folder / "set.json").string(),
            .emotion = "anger",
            .emotions = folder / "track",
            .weights = folder / "w.json",
            .audio = folder / "a.wav",
            .face = folder};
  }

  static std::string print(const SynthOptions& asked) {
    FileFingerprints files;
    return fingerprint(asked, "table", files);
  }

  test::TemporaryFolder folder_;
};

TEST_F(SynthFingerprintTest, ChangesWithEveryOptionThatShapesAResult) {
  const std::vector<std::function<void(SynthOptions&)>> changes = {
      [](SynthOptions& o) { o.outputs.pop_back(); },
      [](SynthOptions& o) { o.outputs[0].replace_extension(".json"); },
      [](SynthOptions& o) { o.phoneme_set = "timit"; },
      [](SynthOptions& o) { o.tier = "phones"; },
      [](SynthOptions& o) { o.emotion = "anger:1"; },
      [](SynthOptions& o) { o.emotions.clear(); },
      [this](SynthOptions& o) { o.constraints = folder_ / "constraints"; },
      [](SynthOptions& o) { o.weights.clear(); },
      [](SynthOptions& o) { o.audio.clear(); },
      [](SynthOptions& o) { o.fps = 24.0; },
      [](SynthOptions& o) { o.head = HeadPose{}; },
      [](SynthOptions& o) {
        o.head = HeadPose{.translation_mm = {0.0, 1.0, 0.0}};
      },
      [](SynthOptions& o) { o.retime = true; },
      [](SynthOptions& o) { o.silence.fill = SilenceFill::cubic; },
      [](SynthOptions& o) { o.silence.rest_at_ends = false; },
      [](SynthOptions& o) { o.smoothing_half_window = 4; },
      [](SynthOptions& o) { o.runners_up = 4; }};
  expect_all_differ<SynthOptions>(options(folder_.path()), changes, print);
}

TEST_F(SynthFingerprintTest, ChangesWithTheContentOfEveryFile) {
  SynthOptions asked = options(folder_.path());
  asked.constraints = folder_ / "constraints";
  std::set<std::string> seen = {print(asked)};
  for (const char* name : {"a.lab", "track", "constraints", "w.json", "a.wav", "set.json",
                           "face.obj", "markers.tsv"}) {
    write_file(folder_ / name, "other");
    EXPECT_TRUE(seen.insert(print(asked)).second) << name;
  }
  fs::remove(folder_ / "markers.tsv");
  EXPECT_TRUE(seen.insert(print(asked)).second);
  FileFingerprints files;
  EXPECT_NE(fingerprint(asked, "another table", files), fingerprint(asked, "table", files));
}

TEST_F(SynthFingerprintTest, StaysWhereverTheFilesLieAndHoweverManyThreadsWork) {
  const test::TemporaryFolder elsewhere;
  fill(elsewhere.path());
  SynthOptions moved = options(elsewhere.path());
  moved.threads = 5;
  moved.make_folders = true;
  moved.database = "other.db";
  EXPECT_EQ(print(moved), print(options(folder_.path())));
}

TEST_F(SynthFingerprintTest, AFaceCountsOnlyWhereItIsShown) {
  SynthOptions asked = options(folder_.path());
  asked.outputs = {"a.csv"};
  const std::string before = print(asked);
  write_file(folder_ / "face.obj", "other");
  EXPECT_EQ(print(asked), before);
}

TEST_F(SynthFingerprintTest, AMissingFileIsAnError) {
  SynthOptions asked = options(folder_.path());
  asked.transcript = folder_ / "none.lab";
  EXPECT_THROW(print(asked), IoError);
  asked = options(folder_.path());
  asked.face = folder_ / "none";
  EXPECT_THROW(print(asked), IoError);
}

} // namespace
} // namespace phonomime
