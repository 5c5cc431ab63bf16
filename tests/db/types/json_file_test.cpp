// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/json_file.h"

#include "corpora_schema/embedded.h"
#include "tests/support/expect_error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace phonomime {
namespace {

using nlohmann::json;
using test::input_error;

json good_corpus() {
  return json::parse(R"({"format": "phonomime-corpus", "version": 1, "name": "c",
    "phoneme_set": "arpabet", "layout": "layout.json", "sentences": "sentences.tsv"})");
}

std::string corpus_error(const json& corpus) {
  return input_error([&] { validate_json(corpus, "corpus", "corpus.json"); });
}

TEST(JsonFile, SyntaxErrorsTellThePlace) {
  EXPECT_EQ(parse_json("[1, 2.5]", "x.json"), (json{1, 2.5}));
  const std::string message = input_error([] { parse_json("{\n \"a\": 1,,\n}", "x.json"); });
  EXPECT_EQ(message.find("x.json: is not JSON: parse error at line 2, column 9"), 0u) << message;
  for (const char* text : {"", "{", "[1,]", "nan", "1e999", "{\"a\" 1}", "\"\xFF\"", "[1] x"}) {
    EXPECT_THROW(parse_json(text, "x.json"), InputError) << text;
  }
}

TEST(JsonFile, DeepNestingIsAnErrorAndNoCrash) {
  const std::string deep(1000000, '[');
  EXPECT_EQ(input_error([&] { parse_json(deep, "x.json"); }),
            "x.json: JSON is nested too deeply (expected at most 64 levels)");
  const std::string fine = std::string(60, '[') + std::string(60, ']');
  EXPECT_NO_THROW(parse_json(fine, "x.json"));
}

TEST(JsonFile, AMemberMayNotStandTwice) {
  EXPECT_NO_THROW(parse_json(R"([{"a": 1}, {"a": {"a": 2}}])", "x.json"));
  EXPECT_EQ(input_error([] { parse_json(R"({"a": {"b": 1}, "c": {"b": 1, "b": 2}})", "x.json"); }),
            "x.json: member \"b\" stands twice in one object. Remove one of the two.");
}

TEST(JsonFile, EverySchemaIsFound) {
  for (const std::string_view path : corpora_schema::embedded_files("schemas/")) {
    const json schema = json::parse(corpora_schema::embedded_file(path));
    const std::string name(path.substr(8, path.find('.') - 8));
    EXPECT_THROW(validate_json(json::array(), name, "x.json"), InputError) << path;
    EXPECT_TRUE(schema.contains("description")) << path;
    for (const auto& [member, about] : schema.at("properties").items()) {
      EXPECT_TRUE(about.contains("description")) << path << ": " << member;
    }
  }
  EXPECT_GE(corpora_schema::embedded_files("schemas/").size(), 4u);
}

TEST(JsonFile, SchemaErrorsNameTheMember) {
  json corpus = good_corpus();
  EXPECT_NO_THROW(validate_json(corpus, "corpus", "corpus.json"));
  corpus["x-studio"] = {{"anything", 1}};
  EXPECT_NO_THROW(validate_json(corpus, "corpus", "corpus.json"));

  corpus["synthethic"] = true;
  EXPECT_EQ(corpus_error(corpus), "corpus.json: $: there is no member \"synthethic\". Did you mean "
                                  "\"synthetic\"? See corpora_schema/corpus.md.");
  corpus = good_corpus();
  corpus.erase("layout");
  EXPECT_EQ(corpus_error(corpus),
            "corpus.json: $: member \"layout\" is missing. See corpora_schema/corpus.md.");
  corpus = good_corpus();
  corpus["version"] = 2;
  EXPECT_EQ(corpus_error(corpus),
            "corpus.json: $.version has an unknown value (expected 1, got 2). "
            "See corpora_schema/corpus.md.");
  corpus = good_corpus();
  corpus["synthetic"] = "yes";
  EXPECT_EQ(corpus_error(corpus),
            "corpus.json: $.synthetic has the wrong type (expected boolean, got "
            "\"yes\"). See corpora_schema/corpus.md.");
  corpus = good_corpus();
  corpus["reference_frame"] = {{{"sentence", "a"}, {"time", 0}}, {{"sentence", "a"}, {"time", -1}}};
  EXPECT_EQ(corpus_error(corpus).find("corpus.json: $.reference_frame[1].time: "), 0u);
  corpus["reference_frame"] = {{"sentence", "a"}};
  EXPECT_EQ(corpus_error(corpus), "corpus.json: $.reference_frame: member \"time\" is missing. See "
                                  "corpora_schema/corpus.md.");
}

TEST(JsonFile, CostWeightsKeepTheirRanges) {
  const auto fits = [](const char* member, const json& value) {
    try {
      validate_json({{member, value}}, "weights", "w.json");
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  for (const char* member : {"alpha1", "alpha2", "alpha3", "alpha5", "alpha6", "pnt"}) {
    EXPECT_TRUE(fits(member, 0)) << member;
    EXPECT_TRUE(fits(member, 12.5)) << member;
    EXPECT_FALSE(fits(member, -0.1)) << member;
    EXPECT_FALSE(fits(member, "1")) << member;
  }
  EXPECT_TRUE(fits("alpha4", 0.3));
  EXPECT_FALSE(fits("alpha4", 0));
  EXPECT_FALSE(fits("alpha4", 1));
  EXPECT_FALSE(fits("alpha4", 1.5));
  EXPECT_FALSE(fits("alpha7", 0.5));
}

} // namespace
} // namespace phonomime
