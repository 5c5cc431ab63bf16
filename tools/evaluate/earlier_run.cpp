// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"
#include "db/types/json_file.h"
#include "db/types/text.h"
#include "tools/evaluate/compare.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

using nlohmann::json;

// The measures of a report that this program knows; it has to compute them alike.
std::vector<Measure> read_measures(const json& rows, LayoutKind kind, std::string_view where) {
  std::vector<Measure> measures;
  for (const json& row : rows) {
    const auto id = row.at("id").get<std::string>();
    const auto measure = find_measure(id);
    if (!measure) {
      continue;
    }
    const auto demand = [&](const char* member, std::string_view expected) {
      const auto got = row.at(member).get<std::string>();
      if (got != expected) {
        throw InputError({.where = std::string(where),
                          .what = "measure " + quoted(id) + " has another " + member + " there",
                          .expected = std::string(expected),
                          .got = got,
                          .remedy = "Evaluate the earlier run again with this version."});
      }
    };
    demand("unit", unit_of(*measure, kind));
    demand("formula", info(*measure).formula);
    demand("mask", info(*measure).mask);
    measures.push_back(*measure);
  }
  std::ranges::sort(measures);
  if (measures.empty()) {
    throw InputError({.where = std::string(where), .what = "the report has no known measure"});
  }
  return measures;
}

EarlierRun::Method read_method(const json& method, const std::vector<Measure>& measures) {
  EarlierRun::Method read = {.id = method.at("id").get<std::string>()};
  for (const json& sentence : method.at("sentences")) {
    EarlierRun::Sentence one = {.key = sentence.at("key").get<std::string>(),
                                .frame_count = sentence.at("frames").get<std::int64_t>()};
    for (const Measure measure : measures) {
      const auto value = sentence.at("values").find(info(measure).id);
      if (value != sentence.at("values").end() && value->is_number()) {
        one.values[measure] = value->get<double>();
      }
    }
    read.sentences.push_back(std::move(one));
  }
  std::ranges::sort(read.sentences, {}, &EarlierRun::Sentence::key);
  return read;
}

} // namespace

EarlierRun parse_evaluation(std::string_view json_text, std::string_view where) {
  const json report = parse_json_as("evaluation", json_text, where);
  EarlierRun run;
  run.source = where;
  run.corpus = report.at("corpus").get<std::string>();
  run.held_out_by = report.at("held_out_by").get<std::string>();
  run.rate_hz = report.at("rate").get<double>();
  run.main_method = report.at("main_method").get<std::string>();
  const bool markers = report.at("layout").at("kind").get<std::string>() == "markers";
  run.measures = read_measures(report.at("measures"),
                               markers ? LayoutKind::markers : LayoutKind::weights, where);
  for (const json& method : report.at("methods")) {
    run.methods.push_back(read_method(method, run.measures));
  }
  return run;
}

} // namespace phonomime
