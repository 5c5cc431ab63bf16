// SPDX-License-Identifier: GPL-3.0-or-later
//
// A motion file is read as an import reads it.
#include "tools/app/motion_file.h"

#include "db/store/motion_database.h"
#include "db/types/file_io.h"
#include "synth/export/motion_csv.h"
#include "tests/db/import/importer/corpus_folder.h"
#include "tests/support/expect_error.h"
#include "tools/app/import_corpus.h"

#include <gtest/gtest.h>

namespace phonomime {
namespace {

class MotionFileTest : public ::testing::Test {
protected:
  MotionFileTest() {
    folder.write("a.csv", test::CorpusFolder::motion(100, 0.7));
    folder.write("a.lab", "#\n0.3 100 sil\n0.55 100 B\n0.8 100 IH1\n1.1 100 N\n1.4 100 AH0\n"
                          "1.7 100 F\n2.0 100 sil\n");
    folder.write_table("a\ta.csv\ta.lab\n");
    ImportOptions options;
    options.corpus = folder.corpus();
    options.database = folder.outside("m.db");
    import_corpus(options, {});
    table = MotionDatabase::open(options.database, OpenMode::read_only).load_motion_table("");
  }

  // CSV and blobs round to 1e-4 mm or so.
  void expect_imported(const ProjectedMotion& projected) const {
    ASSERT_EQ(projected.coefficients.rows(), table.coefficients.rows());
    const FrameMatrixD expected = table.coefficients.cast<double>();
    ASSERT_GT(expected.cwiseAbs().maxCoeff(), 1.0);
    EXPECT_LT((projected.coefficients - expected).cwiseAbs().maxCoeff(), 2e-3);
  }

  test::CorpusFolder folder;
  MotionTable table;
};

// The frames of the import itself, in its own coefficients.
TEST_F(MotionFileTest, IsReadAsAnImportReadsIt) {
  const MotionFile file = read_motion_file(folder.corpus() / "a.csv", table);
  EXPECT_EQ(file.rate_hz, table.rate_hz);
  EXPECT_EQ(file.recorded_hz, 50.0);
  EXPECT_EQ(file.head.size(), static_cast<std::size_t>(file.frame_count()));
  expect_imported(project_motion(file, table.pca));
}

// Another axis up, as the layout of its corpus says.
TEST_F(MotionFileTest, TakesTheAxesOfALayout) {
  std::string layout = folder.read("layout.json");
  const std::string axes = R"("y": "up", "z": "towards the camera")";
  layout.replace(layout.find(axes), axes.size(), R"("z": "up", "y": "towards the camera")");
  folder.write("z_up.json", layout);
  std::string text = "time";
  for (const ChannelGroup& group : table.layout.groups) {
    text += fmt::format(",{0}_x,{0}_y,{0}_z", group.name);
  }
  for (Eigen::Index k = 0; k < table.coefficients.rows(); ++k) {
    const Eigen::VectorXd mm =
        table.pca.reconstruct(table.coefficients.row(k).cast<double>().transpose());
    text += fmt::format("\n{:.4f}", static_cast<double>(k) / table.rate_hz);
    for (Eigen::Index c = 0; c < mm.size(); c += 3) {
      text += fmt::format(",{:.6f},{:.6f},{:.6f}", mm[c], mm[c + 2], mm[c + 1]);
    }
  }
  folder.write("z_up.csv", text);
  const MotionFile file = read_motion_file(folder.corpus() / "z_up.csv", table,
                                           {.layout = folder.corpus() / "z_up.json"});
  expect_imported(project_motion(file, table.pca));
}

// What synth writes is read back: the head is off already, and the coefficients are the same.
TEST_F(MotionFileTest, ReadsWhatIsWritten) {
  CoefficientMotion motion{.rate_hz = table.rate_hz,
                           .coefficients = table.coefficients.cast<double>()};
  folder.write("out.csv", marker_csv(table.layout, table.pca, motion, false));
  const MotionFile file = read_motion_file(folder.corpus() / "out.csv", table, {}, 25.0);
  EXPECT_EQ(file.frame_count(), (table.coefficients.rows() + 1) / static_cast<Eigen::Index>(2 * 2));
  expect_imported(project_motion(read_motion_file(folder.corpus() / "out.csv", table), table.pca));
}

TEST_F(MotionFileTest, SaysWhatIsWrong) {
  const auto read = [&](std::string_view name) {
    return [&, name] { read_motion_file(folder.corpus() / name, table); };
  };
  folder.write("weights.csv", "time,r1,r2\n0,0.1,0.2\n0.02,0.1,0.2\n");
  test::expect_error(read("weights.csv"), "recording is of another kind than the layout");
  std::string renamed = folder.read("a.csv");
  for (const char* axis : {"x", "y", "z"}) {
    const std::string name = fmt::format("upper_{}", axis);
    renamed.replace(renamed.find(name), name.size(), fmt::format("uper_{}", axis));
  }
  folder.write("renamed.csv", renamed);
  test::expect_error(read("renamed.csv"), "Did you mean \"uper\"?");
  std::string missing = renamed.substr(0, renamed.find('\n') + 1);
  missing.replace(missing.find("uper"), 4, "upper");
  missing.replace(missing.find("uper"), 4, "upper");
  missing.replace(missing.find("uper"), 4, "upper");
  for (int k = 0; k < 4; ++k) {
    missing += fmt::format("{:.2f},-40,30,0,40,30,0,0,60,5,0,10,20,,,,0,-34,14\n", k / 50.0);
  }
  folder.write("missing.csv", missing);
  test::expect_error(read("missing.csv"),
                     "1 of 6 groups missing throughout the motion of the file: \"upper\"");
}

} // namespace
} // namespace phonomime
