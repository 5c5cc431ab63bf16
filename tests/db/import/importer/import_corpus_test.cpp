// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/import_corpus.h"

#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "tests/db/import/importer/corpus_folder.h"
#include "tests/support/expect_error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <atomic>
#include <cmath>

namespace phonomime {
namespace {

ImportOptions options_for(const test::CorpusFolder& folder) {
  ImportOptions options;
  options.corpus = folder.corpus();
  options.database = folder.database();
  return options;
}

TEST(ImportCorpus, PutsEverySentenceIntoANewDatabase) {
  const test::CorpusFolder folder;
  const ImportReport report = import_corpus(options_for(folder), {});
  EXPECT_EQ(report.sentences_imported, 2);
  EXPECT_EQ(report.rate_hz, 100.0);
  EXPECT_EQ(report.frames, 400);
  EXPECT_EQ(report.in_nodes, 280);
  EXPECT_EQ(report.nodes, 10);
  EXPECT_EQ(report.missing, 0);
  const MotionDatabase database = MotionDatabase::open(folder.database(), OpenMode::read_only);
  EXPECT_EQ(database.info().nodes, 10);
  const MotionTable table = database.load_motion_table("");
  EXPECT_EQ(table.speaker, "small");
  EXPECT_EQ(table.node_frames(table.find_node("b#2", "test")).rows(), 25);
  // The stored face is as still as the head is rigid, and the reference is centred on it.
  const FrameMatrix channels = database.load_channels(table.sentences[0]);
  for (int group = 0; group < 4; ++group) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto column = channels.col(3 * group + axis);
      EXPECT_LT(column.maxCoeff() - column.minCoeff(), 2e-3f) << group;
    }
  }
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int group = 0; group < 4; ++group) {
    centre += table.reference_pose.segment<3>(3 * group) / 4.0;
  }
  EXPECT_LT(centre.norm(), 1e-6);
  // Pose and face together are the recording again.
  const std::vector<HeadPose> head = database.load_head(table.sentences[0]);
  const Eigen::Vector3d lower =
      head[40].rotation * channels.row(40).segment<3>(15).cast<double>().transpose() +
      head[40].translation_mm;
  std::istringstream lines(folder.read("a.csv"));
  std::string line;
  for (int i = 0; i <= 21; ++i) {
    std::getline(lines, line); // the header, then frame 20 at 0.4 s
  }
  double recorded[3];
  std::size_t at = line.size();
  for (int axis = 2; axis >= 0; --axis) {
    const std::size_t comma = line.rfind(',', at - 1);
    recorded[axis] = std::stod(line.substr(comma + 1, at - comma - 1));
    at = comma;
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(lower(axis), recorded[axis], 1e-3);
  }
}

TEST(ImportCorpus, TheReportAddsUp) {
  const test::CorpusFolder folder;
  // A gap to fill, one to hold at the end and one too long, in the sentence b.
  std::istringstream lines(folder.read("b.csv"));
  std::string spoilt;
  std::string line;
  for (int k = -1; std::getline(lines, line); ++k) {
    const bool missing = (k >= 30 && k < 33) || (k >= 60 && k < 70) || k >= 98;
    if (missing) {
      for (int axis = 0; axis < 3; ++axis) {
        line.erase(line.rfind(','));
      }
      line += ",,,";
    }
    spoilt += line + '\n';
  }
  folder.write("b.csv", spoilt);
  const ImportReport report = import_corpus(options_for(folder), {});
  EXPECT_EQ(report.sentences_listed,
            report.sentences_imported + static_cast<std::int64_t>(report.rejected.size()));
  EXPECT_EQ(report.file_frames - report.frames_outside + report.frames_shared,
            report.imported_recorded_frames + report.rejected_recorded_frames);
  EXPECT_EQ(report.frames, report.in_nodes + report.in_silence);
  EXPECT_EQ(report.pca_frames, report.frames - report.gap_frames);
  EXPECT_EQ(report.missing, report.filled + report.held + report.marked);
  EXPECT_EQ(report.filled, 3);
  EXPECT_EQ(report.held, 2);
  EXPECT_EQ(report.marked, 10);
  ASSERT_EQ(report.gaps.size(), 3u);
  EXPECT_EQ(report.gaps[0].file, "b.csv");
  EXPECT_EQ(report.gaps[0].sentence, "small/neutral/b");
  EXPECT_NEAR(report.gaps[0].start_s, 0.6, 1e-9);
  EXPECT_EQ(report.gaps[0].groups, std::vector<std::string>{"lower"});
  EXPECT_EQ(report.nodes_with_gap, 1); // 1.2 s to 1.4 s is inside AH0
  EXPECT_EQ(report.suspects.at("gap"), 1);
  EXPECT_EQ(report.gap_frames, 30);
  const nlohmann::json json = report_to_json(report);
  EXPECT_EQ(json["gaps"]["list"].size(), 3u);
  EXPECT_EQ(json["frames"]["in_pca"], 370);
  EXPECT_NE(report_to_text(report).find("b.csv at 1.20 s: 10 frames of lower"), std::string::npos);
  const MotionDatabase database = MotionDatabase::open(folder.database(), OpenMode::read_only);
  EXPECT_EQ(database.info().with_gaps, 1);
  EXPECT_EQ(database.info().corpora.at(0).report_json, json.dump());
}

TEST(ImportCorpus, CutsSentencesOutOfLongerFiles) {
  const test::CorpusFolder folder;
  folder.write("sentences.tsv", "id\tmotion\talignment\tstart\tend\n"
                                "whole\ta.csv\ta.lab\n"
                                "first\tb.csv\tb.lab\t0\t0.8\n"
                                "second\tb.csv\tb.lab\t1.1\t1.9\n");
  const ImportReport report = import_corpus(options_for(folder), {});
  EXPECT_EQ(report.files, 2);
  EXPECT_EQ(report.file_frames, 200);
  EXPECT_EQ(report.frames_outside, 20); // 0.8 s to 1.1 s and 1.9 s to 2 s at 50 Hz
  EXPECT_EQ(report.imported_recorded_frames, 180);
  const MotionDatabase database = MotionDatabase::open(folder.database(), OpenMode::read_only);
  const MotionTable table = database.load_motion_table("");
  const MotionNode& node =
      table.nodes[static_cast<std::size_t>(table.find_node("second#0", "test"))];
  EXPECT_EQ(table.phonemes[static_cast<std::size_t>(node.phoneme)].name, "ah");
  EXPECT_EQ(node.frame_count, 30);
  folder.write("sentences.tsv", "id\tmotion\talignment\tstart\tend\n"
                                "first\tb.csv\tb.lab\t0\t0.7\n");
  ImportOptions again = options_for(folder);
  again.database += "2";
  again.recordings.tolerance_s = 0.01;
  EXPECT_THROW(import_corpus(again, {}), InputError);
}

TEST(ImportCorpus, ASecondCorpusKeepsTheSpeakersReferencePose) {
  const test::CorpusFolder folder;
  import_corpus(options_for(folder), {});
  const auto pose = [&] {
    return MotionDatabase::open(folder.database(), OpenMode::read_only)
        .load_motion_table("small")
        .reference_pose;
  };
  const Eigen::VectorXd before = pose();
  folder.write("c.csv", test::CorpusFolder::motion(100, 2.5));
  folder.write_table("c\tc.csv\ta.lab\n");
  const ImportReport report = import_corpus(options_for(folder), {});
  EXPECT_EQ(report.references.at(0).origin, "database");
  EXPECT_EQ(report.pca_frames, 600);
  EXPECT_EQ(pose(), before);
  ImportOptions faster = options_for(folder);
  faster.rate_hz = 120.0;
  EXPECT_THROW(import_corpus(faster, {}), InputError);
}

// The last marker (3 numbers) of each frame, all sentences.
FrameMatrix last_marker(const test::CorpusFolder& folder) {
  const MotionDatabase database = MotionDatabase::open(folder.database(), OpenMode::read_only);
  FrameMatrix frames(0, 3);
  for (const SentenceInfo& sentence : database.load_motion_table("small").sentences) {
    const FrameMatrix channels = database.load_channels(sentence);
    frames.conservativeResize(frames.rows() + channels.rows(), 3);
    frames.bottomRows(channels.rows()) = channels.rightCols(3);
  }
  return frames;
}

TEST(ImportCorpus, AHeadThatNearsASingleCameraIsBroughtToOneSize) {
  const test::CorpusFolder folder;
  EXPECT_EQ(import_corpus(options_for(folder), {}).head_scale.scale, "measured");
  const FrameMatrix as_made = last_marker(folder);
  std::filesystem::remove(folder.database());

  folder.write("b.csv", test::CorpusFolder::motion(100, 1.0, 1.04));
  const ImportReport report = import_corpus(options_for(folder), {});
  EXPECT_EQ(report.head_scale.scale, "nominal");
  EXPECT_EQ(report.head_scale.origin, "found");
  EXPECT_NEAR(report.head_scale.size_variation, 0.5 * std::log(1.04), 1e-4);
  // One of the two sizes is the reference's: all is as made, or 1.04 times that.
  const FrameMatrix brought = last_marker(folder);
  const float factor = brought.row(0).norm() / as_made.row(0).norm();
  EXPECT_NEAR(factor < 1.02f ? 1.0f : 1.04f, factor, 1e-3);
  EXPECT_LT((brought - factor * as_made).cwiseAbs().maxCoeff(), 0.05f);

  // Later corpora of the database go by the same, whatever they measure.
  folder.write_table("c\ta.csv\ta.lab\n");
  EXPECT_EQ(import_corpus(options_for(folder), {}).head_scale.origin, "database");
  folder.write_table("d\ta.csv\ta.lab\n");
  ImportOptions otherwise = options_for(folder);
  otherwise.recordings.scale = Scale::measured;
  EXPECT_NE(test::input_error([&] { import_corpus(otherwise, {}); }).find("scale"),
            std::string::npos);
  std::filesystem::remove(folder.database());
  EXPECT_EQ(import_corpus(otherwise, {}).head_scale.origin, "asked for");
}

TEST(ImportCorpus, ANamedReferenceFrameIsTaken) {
  const test::CorpusFolder folder;
  folder.write("corpus.json", R"({"format": "phonomime-corpus", "version": 1, "name": "small",
      "phoneme_set": "arpabet", "layout": "layout.json", "sentences": "sentences.tsv",
      "reference_frame": {"sentence": "b", "time": 1.0}})");
  const ImportReport report = import_corpus(options_for(folder), {});
  EXPECT_EQ(report.references.at(0).origin, "named frame");
  EXPECT_EQ(report.references.at(0).sentence, "small/neutral/b");
  EXPECT_NEAR(report.references.at(0).time_s, 1.0, 1e-9);
}

TEST(ImportCorpus, FaultySentencesAreLeftOutAndReportedOnlyWhereThatIsAsked) {
  const test::CorpusFolder folder;
  folder.write("b.lab", "#\n0.3 100 sil\n0.5 100 QQ\n2.0 100 sil\n");
  EXPECT_THROW(import_corpus(options_for(folder), {}), InputError);
  ImportOptions options = options_for(folder);
  options.recordings.skip_faulty = true;
  const ImportReport report = import_corpus(options, {});
  EXPECT_EQ(report.sentences_imported, 1);
  ASSERT_EQ(report.rejected.size(), 1u);
  EXPECT_EQ(report.rejected[0].id, "b");
  EXPECT_NE(report.rejected[0].reason.find("QQ"), std::string::npos);
  EXPECT_EQ(report.frames_outside, 100);
}

TEST(ImportCorpus, GivesTheSameNumbersAtAnyThreadCount) {
  const test::CorpusFolder folder;
  std::string rows;
  for (int i = 0; i < 20; ++i) {
    folder.write(fmt::format("{}.csv", i), test::CorpusFolder::motion(100, 0.1 * i));
    rows += fmt::format("s{0}\t{0}.csv\ta.lab\n", i);
  }
  folder.write_table(rows);
  const auto imported = [&](int threads) {
    ImportOptions options = options_for(folder);
    options.database += std::to_string(threads);
    options.recordings.threads = threads;
    import_corpus(options, {});
    return MotionDatabase::open(options.database, OpenMode::read_only).load_motion_table("");
  };
  const MotionTable one = imported(1);
  const MotionTable many = imported(4);
  EXPECT_EQ(many.nodes.size(), 100u);
  EXPECT_EQ(many.coefficients, one.coefficients);
  EXPECT_EQ(many.pca.basis, one.pca.basis);
  EXPECT_EQ(many.reference_pose, one.reference_pose);
}

TEST(ImportCorpus, AStopLeavesNothing) {
  const test::CorpusFolder folder;
  std::atomic<bool> stop = false;
  Progress progress;
  progress.stop = &stop;
  progress.report = [&](std::string_view stage, std::int64_t, std::int64_t) {
    stop = stop || stage == "importing";
  };
  EXPECT_THROW(import_corpus(options_for(folder), progress), Interrupted);
  EXPECT_FALSE(std::filesystem::exists(folder.database()));
}

TEST(ImportCorpus, OptionsOutOfRangeAreRefused) {
  const test::CorpusFolder folder;
  ImportOptions options = options_for(folder);
  options.rate_hz = -5.0;
  EXPECT_THROW(import_corpus(options, {}), UsageError);
  options.rate_hz = 0.0;
  options.pca.share = 1.5;
  EXPECT_THROW(import_corpus(options, {}), UsageError);
}

} // namespace
} // namespace phonomime
