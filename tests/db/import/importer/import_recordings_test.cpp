// SPDX-License-Identifier: GPL-3.0-or-later
// Real recordings, where they are there.
#include "tools/app/import_corpus.h"

#include "db/import/readers.h"
#include "db/store/motion_database.h"
#include "tests/db/import/importer/corpus_folder.h"
#include "tests/support/shared_data.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace phonomime {
namespace {

TEST(ImportRecordings, GridIsAccountedForToTheLastFrame) {
  PHONOMIME_NEEDS_SHARED_DATA(shared);
  const test::CorpusFolder folder;
  ImportOptions options;
  options.corpus = shared / "grid_s1";
  options.database = folder.database();
  options.recordings.threads = 2;
  const ImportReport report = import_corpus(options, {});
  EXPECT_EQ(report.sentences_imported, 800);
  EXPECT_TRUE(report.rejected.empty());
  EXPECT_EQ(report.file_frames, 60000);
  EXPECT_EQ(report.imported_recorded_frames, 60000);
  EXPECT_EQ(report.frames, 240000);
  EXPECT_EQ(report.frames, report.in_nodes + report.in_silence);
  EXPECT_EQ(report.pca_frames + report.pca_left_out, report.frames);
  EXPECT_EQ(report.missing, report.filled + report.held + report.marked);
  EXPECT_GT(report.pca_share, 0.98);

  const MotionDatabase database = MotionDatabase::open(folder.database(), OpenMode::read_only);
  const MotionTable table = database.load_motion_table("s1");
  const std::vector<int> rigid = table.layout.groups_in(Region::rigid);
  double residual_sq = 0.0, variance_sq = 0.0, rigid_sq = 0.0, recorded_error = 0.0;
  std::int64_t frames = 0;
  for (std::size_t i = 0; i < table.sentences.size(); i += 40) {
    const FrameMatrixD channels = database.load_channels(table.sentences[i]).cast<double>();
    const FrameMatrixD centred = channels.rowwise() - table.pca.mean.transpose();
    residual_sq +=
        (centred - (centred * table.pca.basis) * table.pca.basis.transpose()).squaredNorm();
    variance_sq += centred.squaredNorm();
    for (const int group : rigid) {
      rigid_sq += (channels.middleCols(3 * group, 3).rowwise() -
                   table.reference_pose.segment<3>(3 * group).transpose())
                      .squaredNorm();
    }
    frames += channels.rows();
    // Head and face together are the file's own markers, at every fourth frame, but for the head's
    // size, which a single camera does not know: the upper lip tells it, the lower one is judged.
    const std::vector<HeadPose> head = database.load_head(table.sentences[i]);
    const MotionClip clip =
        read_motion(shared / "grid_s1" / "motion" / (table.sentences[i].id + ".c3d"));
    const auto lip = static_cast<Eigen::Index>(*table.layout.find_landmark("lip_lower_inner"));
    const auto upper = static_cast<Eigen::Index>(*table.layout.find_landmark("lip_upper_inner"));
    const auto column_of = [&](Eigen::Index group) {
      return 3 * (std::ranges::find(clip.groups, table.layout.groups[group].name) -
                  clip.groups.begin());
    };
    for (Eigen::Index k = 0; k < clip.frame_count(); ++k) {
      const HeadPose& pose = head[static_cast<std::size_t>(4 * k)];
      const auto recorded = [&](Eigen::Index group) -> Eigen::Vector3d {
        return clip.frames.row(k).segment<3>(column_of(group)).cast<double>().transpose() -
               pose.translation_mm;
      };
      const auto turned = [&](Eigen::Index group) -> Eigen::Vector3d {
        return pose.rotation * channels.row(4 * k).segment<3>(3 * group).transpose();
      };
      const double size = recorded(upper).dot(turned(upper)) / turned(upper).squaredNorm();
      if (recorded(lip).allFinite() && std::isfinite(size)) {
        recorded_error = std::max(recorded_error, (size * turned(lip) - recorded(lip)).norm());
        EXPECT_NEAR(size, 1.0, 0.15);
      }
    }
  }
  EXPECT_LT(residual_sq / variance_sq, 1.05 * (1.0 - report.pca_share));
  EXPECT_LT(std::sqrt(rigid_sq / static_cast<double>(frames * rigid.size())), 1.5); // mm
  EXPECT_LT(recorded_error, 1e-3);

  ImportOptions alone = options;
  alone.database += ".1";
  alone.recordings.threads = 1;
  EXPECT_EQ(report_to_json(import_corpus(alone, {})).dump(), report_to_json(report).dump());
  const MotionTable same =
      MotionDatabase::open(alone.database, OpenMode::read_only).load_motion_table("s1");
  EXPECT_EQ(same.coefficients, table.coefficients);
  EXPECT_EQ(same.pca.basis, table.pca.basis);
  EXPECT_EQ(same.reference_pose, table.reference_pose);
}

TEST(ImportRecordings, LiveLinkTakesGoInAsWeights) {
  PHONOMIME_NEEDS_SHARED_DATA(shared);
  const test::CorpusFolder folder;
  const MotionClip takes[] = {read_motion(shared / "livelink" / "alexdjulin" / "alex_rom_3.csv"),
                              read_motion(shared / "livelink" / "sentien" / "recording.csv")};
  std::filesystem::copy(shared / "livelink" / "alexdjulin" / "alex_rom_3.csv",
                        folder.corpus() / "alex.csv");
  std::filesystem::copy(shared / "livelink" / "sentien" / "recording.csv",
                        folder.corpus() / "sentien.csv");
  nlohmann::json layout = {{"format", "phonomime-layout"},
                           {"version", 1},
                           {"kind", "weights"},
                           {"groups", nlohmann::json::array()}};
  for (std::size_t i = 0; i < 52; ++i) {
    layout["groups"].push_back({{"name", takes[0].groups[i]}});
  }
  folder.write("layout.json", layout.dump());
  for (int take = 0; take < 2; ++take) {
    std::string text = "#\n0.5 100 sil\n";
    const char* phonemes[] = {"B", "AA1", "T", "IY0", "M", "OW1", "F", "S"};
    double time_s = 0.5;
    for (int i = 0; time_s + 0.2 < takes[take].duration_s(); ++i) {
      time_s += 0.09;
      text += fmt::format("{:.3f} 100 {}\n", time_s, phonemes[i % 8]);
    }
    text += fmt::format("{:.6f} 100 sil\n", takes[take].duration_s());
    folder.write(take == 0 ? "alex.lab" : "sentien.lab", text);
  }
  folder.write("sentences.tsv", "id\tspeaker\tmotion\talignment\n"
                                "rom\talex\talex.csv\talex.lab\n"
                                "take\tsentien\tsentien.csv\tsentien.lab\n");
  ImportOptions options;
  options.corpus = folder.corpus();
  options.database = folder.database();
  const ImportReport report = import_corpus(options, {});
  EXPECT_EQ(report.sentences_imported, 2);
  EXPECT_EQ(report.file_frames, takes[0].frame_count() + takes[1].frame_count());
  EXPECT_EQ(report.extra_groups.size(), 9u); // the angles of head and eyes
  const MotionDatabase database = MotionDatabase::open(folder.database(), OpenMode::read_only);
  const MotionTable table = database.load_motion_table("alex");
  EXPECT_EQ(table.layout.kind, LayoutKind::weights);
  EXPECT_TRUE(table.reference_pose.isZero());
  const FrameMatrix channels = database.load_channels(table.sentences[0]);
  EXPECT_GE(channels.minCoeff(), 0.0f);
  const auto recorded = takes[0].frames.leftCols(52);
  EXPECT_LE(channels.maxCoeff(), recorded.maxCoeff<Eigen::PropagateNumbers>());
  EXPECT_TRUE(database.load_head(table.sentences[0]).empty());
}

} // namespace
} // namespace phonomime
