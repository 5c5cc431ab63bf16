// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/report.h"

#include "db/types/file_io.h"
#include "db/types/json_file.h"
#include "db/types/sentence_key.h"
#include "db/types/text.h"
#include "tests/tools/evaluate/made_evaluation.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace phonomime::test {
namespace {

constexpr int kSentences = 14;
const std::vector<MadeMethod> kMethods = {{"main", 0.6}, {"<other>", 1.1}};

struct Made {
  Evaluation evaluation;
  std::vector<ShownSentence> shown;
  std::optional<Comparison> comparison;
};

Made made() {
  Showcase showcase("main", 3, 2);
  Made all;
  all.evaluation = made_evaluation(kSentences, kMethods, &showcase);
  for (const double share : {0.25, 0.5, 1.0}) {
    SizePoint size;
    size.sentences = static_cast<std::int64_t>(share * 100);
    size.nodes = static_cast<std::int64_t>(share * 2000);
    size.diphone_coverage = 0.9 + 0.1 * share;
    size.triphone_coverage = 0.8 * share;
    size.search_s = 0.01 * share;
    size.quality = summarise(all.evaluation.methods[0].sentences);
    all.evaluation.sizes.push_back(size);
  }
  aggregate(all.evaluation);
  Evaluation earlier = made_evaluation(kSentences, {{"main", 0.8}});
  aggregate(earlier);
  all.comparison =
      compare_runs(all.evaluation,
                   parse_evaluation(evaluation_json(earlier, std::nullopt).dump(), "earlier.json"));
  all.shown = showcase.shown();
  return all;
}

TEST(Report, JsonFitsItsSchemaAndIsReadBackWhole) {
  const Made all = made();
  const nlohmann::ordered_json json = evaluation_json(all.evaluation, all.comparison);
  validate_json(nlohmann::json(json), "evaluation", "report");
  const EarlierRun read = parse_evaluation(json.dump(), "report");
  EXPECT_EQ(read.corpus, "made");
  EXPECT_EQ(read.main_method, "main");
  EXPECT_EQ(read.measures.size(), kMeasureCount);
  ASSERT_EQ(read.methods.size(), 2u);
  for (std::size_t m = 0; m < 2; ++m) {
    ASSERT_EQ(read.methods[m].sentences.size(), std::size_t{kSentences});
    for (std::size_t i = 0; i < kSentences; ++i) {
      EXPECT_EQ(read.methods[m].sentences[i].key, all.evaluation.methods[m].sentences[i].key);
      EXPECT_EQ(read.methods[m].sentences[i].values, all.evaluation.tables[m].sentences[i]);
    }
  }
}

TEST(Report, CsvHasALineAMethodAndSentence) {
  const Made all = made();
  const std::string csv = sentences_csv(all.evaluation);
  const auto lines = split_lines(csv);
  ASSERT_EQ(lines.size(), 1u + 2u * kSentences);
  const auto header = split_fields(lines[0], ',');
  ASSERT_EQ(header.size(), 7u + kMeasureCount);
  for (std::size_t line = 1; line < lines.size(); ++line) {
    const auto fields = split_fields(lines[line], ',');
    ASSERT_EQ(fields.size(), header.size()) << lines[line];
    const std::size_t m = (line - 1) / kSentences;
    const std::size_t i = (line - 1) % kSentences;
    EXPECT_EQ(fields[0], kMethods[m].id);
    EXPECT_EQ(fields[2], "s1");
    for (std::size_t c = 0; c < kMeasureCount; ++c) {
      const auto& value = all.evaluation.tables[m].sentences[i][static_cast<Measure>(c)];
      EXPECT_EQ(fields[7 + c].empty() ? std::nullopt : parse_number(fields[7 + c]), value)
          << header[7 + c];
    }
  }
  Evaluation odd = all.evaluation;
  odd.methods[0].id = "a,\"b\"";
  EXPECT_NE(sentences_csv(odd).find("\n\"a,\"\"b\"\"\",s1/"), std::string::npos);
}

TEST(Report, TextNamesEveryMeasureWithUnitMaskAndFormula) {
  const Made all = made();
  const std::string text = evaluation_text(all.evaluation, all.comparison);
  for (const Measure measure : all_measures()) {
    EXPECT_NE(text.find(std::string(info(measure).formula)), std::string::npos);
    EXPECT_NE(text.find(std::string(info(measure).label)), std::string::npos);
  }
  for (const char* part :
       {"Evaluation of made: 14 sentences, 5 folds by sentence, seed 3, at 100 Hz", "E13 [mm^2]",
        "By emotion: main", "By fold: main", "By phoneme, pooled: main", "Against earlier.json",
        "better", "By size of the database", "Worst sentences: main", "total error (E12)"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
  for (const std::string_view line : split_lines(text)) {
    EXPECT_TRUE(line.empty() || line.back() != ' ') << line;
  }
}

TEST(Report, PageIsOneFileThatAsksForNothing) {
  const Made all = made();
  const std::string page = evaluation_html(all.evaluation, all.shown, all.comparison);
  EXPECT_EQ(page.find("@PHONOMIME_"), std::string::npos);
  for (const char* foreign : {"http://", "https://", "src=", "url(", "import "}) {
    const std::size_t at = page.find(foreign);
    const bool is_namespace =
        at != std::string::npos && page.compare(at, 26, "http://www.w3.org/2000/svg") == 0;
    EXPECT_TRUE(at == std::string::npos || is_namespace) << foreign << " at " << at;
  }
  EXPECT_EQ(page.find("<b>up</b>"), std::string::npos); // a sentence's text is no markup
  const std::string_view mark = R"(id="phonomime-data">)";
  const std::size_t begin = page.find(mark) + mark.size();
  const auto data =
      nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  EXPECT_EQ(data.at("shown").size(), all.shown.size());
  EXPECT_EQ(data.at("sentence_values").at("keys").size(), std::size_t{kSentences});
}

TEST(Report, TheSameRunGivesTheSameBytes) {
  const Made one = made();
  const Made other = made();
  EXPECT_EQ(evaluation_json(one.evaluation, one.comparison).dump(),
            evaluation_json(other.evaluation, other.comparison).dump());
  EXPECT_EQ(evaluation_html(one.evaluation, one.shown, one.comparison),
            evaluation_html(other.evaluation, other.shown, other.comparison));
  EXPECT_EQ(evaluation_text(one.evaluation, one.comparison),
            evaluation_text(other.evaluation, other.comparison));
}

// What check_figures.py and report_page.mjs look at: the page, the report, and the motion behind
// it.
TEST(Report, LeavesFilesForOtherReaders) {
  const Made all = made();
  const std::filesystem::path folder = PHONOMIME_REPORT_FOLDER;
  write_file(folder / "report.html", evaluation_html(all.evaluation, all.shown, all.comparison));
  write_file(folder / "report.json", evaluation_json(all.evaluation, all.comparison).dump());
  nlohmann::json motion;
  motion["rate"] = kRate_hz;
  const Eigen::VectorXd rest = rest_pose();
  motion["reference_pose"] = std::vector<double>(rest.data(), rest.data() + rest.size());
  const auto rows_of = [](const FrameMatrix& frames) {
    nlohmann::json rows = nlohmann::json::array();
    for (Eigen::Index k = 0; k < frames.rows(); ++k) {
      rows.push_back(
          std::vector<double>(frames.row(k).data(), frames.row(k).data() + frames.cols()));
    }
    return rows;
  };
  for (int seed = 0; seed < kSentences; ++seed) {
    const ImportedSentence recorded = made_recording(seed);
    nlohmann::json one;
    one["recorded"] = rows_of(recorded.channels);
    one["gaps"] = recorded.frame_has_gap;
    for (const TimedPhoneme& row : recorded.rows) {
      one["rows"].push_back({row.phoneme.name, row.start_s, row.end_s});
    }
    for (const MadeMethod& method : kMethods) {
      const SynthesisedSentence made_one = made_synthesis(method, seed);
      one["methods"][method.id]["channels"] = rows_of(made_one.channels);
      for (const JoinPlace& join : made_one.joins) {
        one["methods"][method.id]["joins"].push_back({join.frame, join.captured});
      }
    }
    motion["sentences"][sentence_key(recorded)] = std::move(one);
  }
  write_file(folder / "motion.json", motion.dump());
}

} // namespace
} // namespace phonomime::test
