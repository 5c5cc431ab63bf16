// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/readers.h"
#include "db/import/sentence_table.h"
#include "db/types/emotion_track.h"
#include "db/types/file_io.h"
#include "db/types/json_file.h"
#include "db/types/layout.h"
#include "db/types/motion_table.h"
#include "db/types/node_constraint.h"
#include "db/types/phoneme_set.h"
#include "db/types/text.h"
#include "synth/retarget/keyshapes/rig.h"
#include "synth/retarget/mapping/pair_table.h"
#include "tests/support/shared_data.h"
#include "tools/app/manifest.h"
#include "tools/evaluate/compare.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace phonomime {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(PHONOMIME_SOURCE_DIR) / "corpora_schema";

// The fenced blocks of a page: "layout.json" -> text, named by page and language of the fence.
std::map<std::string, std::string> examples() {
  std::map<std::string, std::string> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() != ".md") {
      continue;
    }
    const std::string page = read_file(entry.path());
    std::string language;
    std::string text;
    for (const std::string_view line : split_lines(page)) {
      if (!line.starts_with("```")) {
        text += std::string(line) + "\n";
      } else if (language.empty()) {
        language = line.substr(3);
        text.clear();
        EXPECT_FALSE(language.empty()) << entry.path() << ": a block without a language";
      } else {
        EXPECT_TRUE(found.emplace(entry.path().stem().string() + " " + language, text).second)
            << entry.path() << ": two blocks of " << language;
        language.clear();
      }
    }
  }
  return found;
}

TEST(FormatPages, EveryExampleIsWhatItsPageSays) {
  const std::map<std::string, std::function<void(const std::string&)>> checks = {
      {"corpus json",
       [](const std::string& text) {
         const nlohmann::json corpus = parse_json_as("corpus", text, "corpus.md");
         EXPECT_EQ(corpus.at("reference_frame").size(), 2u);
       }},
      {"layout json",
       [](const std::string& text) {
         EXPECT_EQ(parse_layout(text, "layout.md").group_count(), 7);
       }},
      {"sentences tsv",
       [](const std::string& text) {
         const std::vector<SentenceRow> rows = parse_sentence_table(text, "sentences.md", "studio");
         ASSERT_EQ(rows.size(), 3u);
         EXPECT_EQ(rows[1].emotion, "happiness");
         EXPECT_EQ(rows[2].emotion, "neutral");
         EXPECT_EQ(rows[2].start_s, 12.5);
       }},
      {"transcript xlabel",
       [](const std::string& text) {
         const Alignment read = parse_xlabel(text, "transcript.md");
         EXPECT_EQ(to_phonemes(read, PhonemeSet::built_in("festival_us")).size(), 5u);
       }},
      {"transcript htk",
       [](const std::string& text) {
         const Alignment read = parse_htk_label(text, "transcript.md");
         ASSERT_EQ(read.rows.size(), 4u);
         EXPECT_EQ(read.rows[1].start_s, 0.15);
         EXPECT_EQ(to_phonemes(read, PhonemeSet::built_in("arpabet")).size(), 4u);
       }},
      {"transcript textgrid",
       [](const std::string& text) {
         const Alignment read = parse_textgrid(text, "transcript.md");
         EXPECT_EQ(to_phonemes(read, PhonemeSet::built_in("arpabet")).size(), 3u);
       }},
      {"motion marker-csv",
       [](const std::string& text) {
         const MotionClip clip = parse_marker_csv(text, "motion.md");
         EXPECT_EQ(clip.groups, (std::vector<std::string>{"lip_top", "lip_bottom"}));
         EXPECT_NEAR(clip.rate_hz, 100.0, 1e-6);
         EXPECT_TRUE(std::isnan(clip.frames(1, 4)));
       }},
      {"motion weight-csv",
       [](const std::string& text) {
         const MotionClip clip = parse_marker_csv(text, "motion.md");
         EXPECT_EQ(clip.channels_per_group, 1);
         EXPECT_NEAR(clip.rate_hz, 60.0, 1e-3);
       }},
      {"phoneme_set json",
       [](const std::string& text) {
         const PhonemeSet set = PhonemeSet::parse(text, "phoneme_set.md");
         EXPECT_EQ(set.phonemes().size(), 6u);
         EXPECT_EQ(set.find("A1"), 1);
       }},
      {"emotion_track emotion-track",
       [](const std::string& text) {
         const EmotionTrack track = parse_emotion_track(text, "emotion_track.md");
         ASSERT_EQ(track.spans.size(), 4u);
         EXPECT_EQ(track.spans[1].intensity, 0.8);
         EXPECT_EQ(track.spans[3].others.size(), 1u);
       }},
      {"constraints constraints",
       [](const std::string& text) {
         const std::vector<NodeConstraint> read = parse_constraints(text, "constraints.md");
         ASSERT_EQ(read.size(), 3u);
         EXPECT_EQ(read[1].keys.size(), 2u);
       }},
      {"manifest tsv",
       [](const std::string& text) {
         const std::vector<ManifestRow> rows =
             parse_manifest(text, "manifest.md", {.outputs = {"{id}.csv"}});
         ASSERT_EQ(rows.size(), 3u);
         EXPECT_EQ(rows[0].options.outputs.at(1), "out/sc010_0010.csv");
         EXPECT_EQ(rows[0].options.face, "faces/ann");
         EXPECT_EQ(rows[0].options.fps, 24.0);
         EXPECT_EQ(rows[1].options.outputs.at(0), "sc010_0020.csv");
         EXPECT_EQ(rows[1].options.audio, "wav/sc010_0020.wav");
         EXPECT_EQ(rows[2].id, "sc010_0030");
       }},
      {"rig rig",
       [](const std::string& text) { EXPECT_FALSE(parse_rig(text, "rig.md").sets.empty()); }},
      {"pairs tsv",
       [](const std::string& text) {
         const std::vector<std::string> shapes = {"jawOpen", "browInnerUp", "mouthSmile_L"};
         const PairTable read = parse_pair_table(text, "pairs.md", shapes);
         EXPECT_EQ(read.shapes, (std::vector<std::string>{"jawOpen", "mouthSmile_L"}));
         ASSERT_EQ(read.rows.size(), 3u);
         EXPECT_EQ(read.rows[1].frame.node, "ann/happiness/s004#2");
         EXPECT_EQ(read.rows[1].frame.time_s, 0.05);
         EXPECT_EQ(read.weights(1, 0), 0.55);
         EXPECT_EQ(read.weights(2, 0), 0.0);
         EXPECT_EQ(read.weights(2, 1), 0.8);
       }},
      {"weights json",
       [](const std::string& text) {
         const nlohmann::json weights = parse_json_as("weights", text, "weights.md");
         EXPECT_TRUE(weights.contains("alpha6"));
       }},
      {"result json",
       [](const std::string& text) {
         EXPECT_EQ(parse_json_as("result", text, "result.md").at("path").size(), 3u);
       }},
      {"evaluation json",
       [](const std::string& text) {
         const EarlierRun run = parse_evaluation(text, "evaluation.md");
         EXPECT_EQ(run.methods.at(0).sentences.at(1).values[Measure::rmse], 1.8);
       }},
      {"tuning json",
       [](const std::string& text) {
         const nlohmann::json tuning = parse_json_as("tuning", text, "tuning.md");
         EXPECT_EQ(tuning.at("all").at("looks").size(), 2u);
       }},
      {"database key", [](const std::string& text) {
         MotionTable table;
         table.speaker = "s1";
         table.sentences = {{"s1", "happiness", "bbaf2n", ""}};
         table.nodes.resize(1);
         table.nodes[0].order = 5;
         EXPECT_EQ(table.key(0) + "\n", text);
         EXPECT_EQ(table.find_node(trim(text), "database.md"), 0);
       }}};
  const std::map<std::string, std::string> blocks = examples();
  for (const auto& [name, text] : blocks) {
    SCOPED_TRACE(name);
    const auto check = checks.find(name);
    ASSERT_NE(check, checks.end()) << "no test reads this block";
    EXPECT_NO_THROW(check->second(text));
  }
  for (const auto& [name, check] : checks) {
    EXPECT_TRUE(blocks.contains(name)) << "no page has the block " << name;
  }
}

// A page names every member of its schema.
TEST(FormatPages, TheTablesListTheSchemasMembers) {
  for (const char* schema_name :
       {"corpus", "layout", "phoneme_set", "weights", "result", "evaluation"}) {
    const std::string page = read_file(kFolder / (std::string(schema_name) + ".md"));
    const nlohmann::json schema = nlohmann::json::parse(
        read_file(kFolder / "schemas" / (std::string(schema_name) + ".schema.json")));
    for (const auto& [member, about] : schema.at("properties").items()) {
      EXPECT_NE(page.find("`" + member + "`"), std::string::npos) << schema_name << ": " << member;
    }
  }
}

TEST(FormatPages, LinksLeadSomewhere) {
  int links = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() != ".md") {
      continue;
    }
    const std::string page = read_file(entry.path());
    for (std::size_t at = page.find("]("); at != std::string::npos; at = page.find("](", at + 1)) {
      const std::string target = page.substr(at + 2, page.find(')', at) - at - 2);
      EXPECT_TRUE(fs::exists(kFolder / target)) << entry.path() << ": " << target;
      ++links;
    }
  }
  EXPECT_GT(links, 20);
}

} // namespace
} // namespace phonomime
