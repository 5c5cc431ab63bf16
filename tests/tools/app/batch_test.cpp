// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/batch.h"

#include "db/types/file_io.h"
#include "tests/db/import/importer/corpus_folder.h"
#include "tools/app/batch_report.h"
#include "tools/app/import_corpus.h"

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace phonomime {
namespace {

namespace fs = std::filesystem;

// A small database and a manifest of some rows beside it.
class BatchTest : public ::testing::Test {
protected:
  static constexpr int kRows = 6;

  void SetUp() override {
    ImportOptions import;
    import.corpus = corpus_.corpus();
    import.database = corpus_.database();
    import_corpus(import, {});
    std::string manifest = "transcript\toutputs\tweights\n";
    for (int i = 0; i < kRows; ++i) {
      std::string labels = "#\n0.2 100 sil\n";
      for (int k = 0; k < 4; ++k) {
        constexpr const char* kPhonemes[] = {"B", "IH1", "N", "AH0", "F"};
        labels += fmt::format("{} 100 {}\n", 0.3 + 0.1 * k, kPhonemes[(i * 3 + k * (i + 1)) % 5]);
      }
      write_file(place(fmt::format("t{}.lab", i)), labels + "0.9 100 sil\n");
      manifest += fmt::format("t{0}.lab\tout/t{0}.csv; out/t{0}.json\t{1}\n", i,
                              i % 2 == 0 ? "" : "w.json");
    }
    write_file(place("w.json"), R"({"format": "phonomime-weights", "version": 1, "alpha2": 0.7})");
    write_file(options_.manifest, manifest);
  }

  fs::path place(const std::string& name) const { return corpus_.outside(name); }

  BatchReport run(int threads) {
    options_.synth.threads = threads;
    return run_batch(options_, {});
  }

  // An output without the only part that may differ.
  std::string output(const std::string& name) const {
    const std::string text = read_file(place("out/" + name));
    if (!name.ends_with(".json")) {
      return text;
    }
    nlohmann::json result = nlohmann::json::parse(text);
    result["search"].erase("seconds");
    return result.dump();
  }

  std::vector<std::string> outputs() const {
    std::vector<std::string> texts;
    for (int i = 0; i < kRows; ++i) {
      texts.push_back(output(fmt::format("t{}.csv", i)));
      texts.push_back(output(fmt::format("t{}.json", i)));
    }
    return texts;
  }

  test::CorpusFolder corpus_;
  BatchOptions options_{.manifest = place("m.tsv"), .synth = {.database = corpus_.database()}};
};

TEST_F(BatchTest, GivesTheBytesOfSynthOnAnyNumberOfThreads) {
  fs::create_directory(place("out"));
  for (int i = 0; i < kRows; ++i) {
    run_synth(
        {.database = corpus_.database(),
         .transcript = place(fmt::format("t{}.lab", i)),
         .outputs = {place(fmt::format("out/t{}.csv", i)), place(fmt::format("out/t{}.json", i))},
         .weights = i % 2 == 0 ? fs::path() : place("w.json")},
        {});
  }
  const std::vector<std::string> alone = outputs();
  EXPECT_NE(alone[0], alone[2]);
  for (const int threads : {1, 2, 4, 16}) {
    fs::remove_all(place("out"));
    EXPECT_EQ(run(threads).count(RowStatus::done), 6u);
    EXPECT_EQ(outputs(), alone) << threads << " threads";
  }
}

TEST_F(BatchTest, DoesWhatIsNotDoneAndNothingElse) {
  EXPECT_EQ(run(2).count(RowStatus::done), 6u);
  EXPECT_EQ(run(2).count(RowStatus::skipped), 6u);
  write_file(place("t3.lab"), "#\n0.2 100 sil\n0.4 100 B\n0.6 100 sil\n");
  fs::remove(place("out/t0.json"));
  const BatchReport again = run(1);
  for (int i = 0; i < kRows; ++i) {
    EXPECT_EQ(again.rows[static_cast<std::size_t>(i)].status,
              i == 3 || i == 0 ? RowStatus::done : RowStatus::skipped)
        << i;
  }
  options_.redo = true;
  EXPECT_EQ(run(2).count(RowStatus::done), 6u);
}

TEST_F(BatchTest, AFailedRowStopsNoOther) {
  fs::remove(place("t1.lab"));
  write_file(place("t4.lab"), "#\n0.2 100 sil\n0.4 100 BB\n");
  const BatchReport report = run(2);
  EXPECT_EQ(report.count(RowStatus::done), 4u);
  EXPECT_EQ(report.rows[1].status, RowStatus::failed);
  EXPECT_EQ(report.rows[1].error_class, ErrorClass::io);
  EXPECT_EQ(report.rows[4].error_class, ErrorClass::bad_input);
  EXPECT_NE(report.rows[4].error.find("t4.lab:3: "), std::string::npos) << report.rows[4].error;
  EXPECT_EQ(report.worst_error(), ErrorClass::io);
  EXPECT_EQ(batch_to_text(report).substr(0, 36), "6 rows: 4 done, 0 skipped, 2 failed;");
}

TEST_F(BatchTest, StopsBetweenRowsAndSaysWhatIsLeft) {
  std::atomic<bool> stop = false;
  const BatchReport report =
      run_batch(options_, {.report =
                               [&](std::string_view stage, std::int64_t done, std::int64_t total) {
                                 EXPECT_EQ(total, kRows);
                                 stop = stop || (stage == "synthesising" && done == 2);
                               },
                           .stop = &stop});
  EXPECT_GE(report.count(RowStatus::done), 2u);
  EXPECT_GE(report.count(RowStatus::stopped), 1u);
  EXPECT_EQ(report.count(RowStatus::done) + report.count(RowStatus::stopped), 6u);
  const std::size_t before = report.count(RowStatus::done);
  EXPECT_EQ(run(2).count(RowStatus::skipped), before);
}

TEST_F(BatchTest, ShardsTogetherDoEverything) {
  for (long number = 1; number <= 4; ++number) {
    options_.shard = {.number = number, .count = 4};
    const BatchReport report = run(1);
    EXPECT_EQ(report.count(RowStatus::done), report.rows.size()) << "no row twice";
  }
  options_.shard = {};
  EXPECT_EQ(run(2).count(RowStatus::skipped), 6u);
}

} // namespace
} // namespace phonomime
