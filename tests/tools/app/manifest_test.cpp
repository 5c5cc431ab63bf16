// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/manifest.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

namespace fs = std::filesystem;

SynthOptions some_defaults() {
  return {.database = "ann.db",
          .outputs = {"all/{id}.csv", "all/{id}/{id}.json"},
          .emotion = "anger",
          .weights = "all.json",
          .fps = 25.0,
          .runners_up = 7};
}

std::vector<ManifestRow> parse(std::string_view text, const SynthOptions& defaults) {
  return parse_manifest(text, "shots/m.tsv", defaults);
}

void expect_refused(std::string_view text, const std::string& part,
                    const SynthOptions& defaults = some_defaults()) {
  test::expect_error([&] { parse(text, defaults); }, part);
}

TEST(Manifest, ACellHoldsForItsRowAndTheCallForEmptyOnes) {
  const std::vector<ManifestRow> rows = parse(
      "\xEF\xBB\xBFoutputs\ttranscript\temotion\tid\tweights\tface\tfps\tphoneme_set\taudio\r\n"
      "a.glb; sub/b.csv ;\ta.lab\tsadness\ts1\tw.json\tface\t24\tmine.json\t/x/a.wav\r\n"
      "\r\n"
      "\tlab/two.lab\r\n"
      "o/{id}.txt\t/abs/three.TextGrid\t\t\t\t\t\ttimit\r\n",
      some_defaults());
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].id, "s1");
  EXPECT_EQ(rows[0].line, 2);
  EXPECT_EQ(rows[0].options.transcript, "shots/a.lab");
  EXPECT_EQ(rows[0].options.outputs, (std::vector<fs::path>{"shots/a.glb", "shots/sub/b.csv"}));
  EXPECT_EQ(rows[0].options.emotion, "sadness");
  EXPECT_EQ(rows[0].options.weights, "shots/w.json");
  EXPECT_EQ(rows[0].options.face, "shots/face");
  EXPECT_EQ(rows[0].options.fps, 24.0);
  EXPECT_EQ(rows[0].options.phoneme_set, "shots/mine.json");
  EXPECT_EQ(rows[0].options.audio, "/x/a.wav");
  EXPECT_EQ(rows[0].options.database, "ann.db");
  EXPECT_EQ(rows[0].options.runners_up, 7);

  EXPECT_EQ(rows[1].id, "two");
  EXPECT_EQ(rows[1].line, 4);
  EXPECT_EQ(rows[1].options.transcript, "shots/lab/two.lab");
  EXPECT_EQ(rows[1].options.outputs, (std::vector<fs::path>{"all/two.csv", "all/two/two.json"}));
  EXPECT_EQ(rows[1].options.emotion, "anger");
  EXPECT_EQ(rows[1].options.weights, "all.json");
  EXPECT_EQ(rows[1].options.fps, 25.0);

  EXPECT_EQ(rows[2].options.transcript, "/abs/three.TextGrid");
  EXPECT_EQ(rows[2].options.outputs, (std::vector<fs::path>{"shots/o/three.txt"}));
  EXPECT_EQ(rows[2].options.phoneme_set, "timit");
}

TEST(Manifest, EachFaultIsNamedWithItsLine) {
  expect_refused("", "shots/m.tsv: table has no header line");
  expect_refused("id\ttranscript\n", "shots/m.tsv: the manifest has no rows");
  expect_refused("id\toutputs\na\tb.csv\n", "shots/m.tsv:1: column \"transcript\" is missing");
  expect_refused("transcript\temotoin\n", "Did you mean \"emotion\"");
  expect_refused("transcript\n\na.lab\tb\n", "shots/m.tsv:3: line has more fields");
  expect_refused("id\ttranscript\na\n", "shots/m.tsv:2: transcript is empty");
  expect_refused("transcript\n\xFF.lab\n", "shots/m.tsv:2: line is not UTF-8");
  expect_refused("transcript\tfps\na.lab\t24p\n", "shots/m.tsv:2: fps is not a number");
  expect_refused("transcript\tfps\na.lab\t0\n", "shots/m.tsv:2: --fps: is out of range");
  expect_refused("transcript\toutputs\na.lab\tx.mp4\n",
                 "shots/m.tsv:2: shots/x.mp4: the suffix names no kind of output");
  expect_refused("transcript\toutputs\na.lab\tx.glb\n", "shots/m.tsv:2: a .glb or .html output");
  expect_refused("transcript\toutputs\na.lab\t{shot}.csv\n",
                 "shots/m.tsv:2: \"{shot}\" stands for nothing");
  expect_refused("transcript\na.lab\n", "shots/m.tsv:2: the row has no output", SynthOptions{});
  expect_refused("transcript\na.lab\nb.lab\nx/a.TextGrid\n",
                 "shots/m.tsv:4: id \"a\" is there twice, first at line 2");
  expect_refused("transcript\toutputs\na.lab\tx.csv;x.csv\n", "named twice");
}

TEST(Manifest, NoFileIsWrittenTwiceOrWrittenAndRead) {
  const std::string head = "transcript\toutputs\tconstraints\na.lab\tx.json;y.csv\t\n";
  expect_refused(head + "b.lab\tz.csv;../shots/./x.json\t\n", "is written by line 2 too");
  expect_refused(head + "b.lab\tz.csv\ty.csv\n", "shots/m.tsv:2: output shots/y.csv is read too");
  expect_refused(head + "b.lab\t../all.json\t\n", "output all.json is read too, for line 2");
  SynthOptions defaults = some_defaults();
  defaults.phoneme_set = "shots/x.json";
  expect_refused(head, "shots/m.tsv:2: output shots/x.json is read too", defaults);

  const test::TemporaryFolder folder;
  fs::create_directory(folder / "real");
  fs::create_directory_symlink("real", folder / "link");
  const fs::path manifest = folder / "m.tsv";
  test::expect_error(
      [&] {
        parse_manifest("transcript\toutputs\na.lab\treal/x.csv\nb.lab\tlink/x.csv\n", manifest, {});
      },
      "m.tsv:3: output " + (folder / "link/x.csv").string() + " is written by line 2 too");
}

TEST(Manifest, TheCallItselfIsCheckedFirst) {
  const auto refuse = [](const SynthOptions& defaults) {
    EXPECT_THROW(parse("transcript\na.lab\n", defaults), UsageError);
  };
  refuse({.outputs = {"{name}.csv"}});
  refuse({.outputs = {"{id}.csv"}, .fps = 0.5});
  refuse({.outputs = {"{id}.csv"}, .runners_up = -1});
  EXPECT_NO_THROW(parse("transcript\tfps\na.lab\t24\n", {.outputs = {"{id}.csv"}}));
}

} // namespace
} // namespace phonomime
