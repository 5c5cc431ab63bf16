// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/motion_database.h"
#include "synth/search/cost_weights.h"
#include "tests/bench/scale/scaled_table.h"
#include "tests/bench/scale/sections.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

namespace phonomime::bench {
namespace {

constexpr const char* kUsage =
    R"(usage: phonomime_scale_bench [options] DATABASE... PHRASE.lab...

Measures the search on databases of many nodes, made from each DATABASE by resampling and perturbing
its sentences. Every answer is verified before it is timed; stops with 1 where one is wrong.

  --sizes N,N,...    nodes (default 5556,20000,80000)
  --only NAME,...    loading, search, context, plain, beam, soft, edits, streaming (default: all)
  --runs N           of which the median is shown (default 5)
  --limit SECONDS    after which a search with soft penalties is stopped (default 20)
  --verify-up-to N   nodes up to which a slow exact search judges every phrase (default 20000)
  --transcripts N    random ones for the streaming search (default 48)
  --frames N         of the database that is loaded (default 850000)
  --json FILE        the same results as JSON

example: phonomime_scale_bench out/demo.db hello.lab --only search --sizes 5556,20000
)";

template <typename Number>
Number number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value <= 0) {
    throw std::invalid_argument(std::string(text) + " is not a number above 0");
  }
  return value;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

ScaleOptions parse(const std::vector<std::string>& arguments) {
  ScaleOptions options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (!argument.starts_with("--")) {
      const std::filesystem::path file = argument;
      (file.extension() == ".lab" ? options.phrases : options.databases).push_back(file);
      continue;
    }
    if (++i == arguments.size()) {
      throw std::invalid_argument(argument + " has no value");
    }
    const std::string& value = arguments[i];
    if (argument == "--sizes") {
      options.sizes.clear();
      for (const std::string& size : split(value)) {
        options.sizes.push_back(number<NodeIndex>(size));
      }
    } else if (argument == "--only") {
      options.only = split(value);
    } else if (argument == "--runs") {
      options.runs = number<int>(value);
    } else if (argument == "--limit") {
      options.limit_s = number<double>(value);
    } else if (argument == "--verify-up-to") {
      options.verify_up_to = number<NodeIndex>(value);
    } else if (argument == "--transcripts") {
      options.transcripts = number<int>(value);
    } else if (argument == "--frames") {
      options.frames = number<std::int64_t>(value);
    } else if (argument == "--json") {
      options.json = value;
    } else {
      throw std::invalid_argument("there is no option " + argument);
    }
  }
  if (options.databases.empty() || options.phrases.empty()) {
    throw std::invalid_argument("no database, or no phrase");
  }
  return options;
}

MotionTable load(const std::filesystem::path& path) {
  return MotionDatabase::open(path, OpenMode::read_only).load_motion_table("");
}

std::vector<Subject> make_subjects(Report& report, const ScaleOptions& options) {
  report.section("The databases (cheapest join: median, mm/s; spread: standard deviations)",
                 {"database        ", "nodes", "frames", "emotions", "spread", "cheapest",
                  "of source", "PNT"});
  std::vector<Subject> subjects;
  for (const std::filesystem::path& path : options.databases) {
    const MotionTable source = load(path);
    for (const NodeIndex size : options.sizes) {
      ScaledTable scaled = scaled_like(source, size);
      Subject subject;
      subject.name = fmt::format("{} {}", path.stem().string(), size);
      subject.table = std::move(scaled.table);
      subject.weights = default_cost_weights(subject.table);
      subject.phrases = read_phrases(subject.table, options.phrases);
      report.row({subject.name, static_cast<double>(subject.table.node_count()),
                  static_cast<double>(subject.table.coefficients.rows()),
                  static_cast<double>(subject.table.emotions.size()), scaled.spread,
                  scaled.cheapest_join, scaled.source_cheapest_join, subject.weights.pnt});
      subjects.push_back(std::move(subject));
    }
  }
  return subjects;
}

void run(const ScaleOptions& options) {
  const auto wanted = [&](std::string_view section) {
    return options.only.empty() || std::ranges::find(options.only, section) != options.only.end();
  };
  Report report;
  if (wanted("loading")) { // first: its processes must begin small
    report_loading(report, options);
  }
  if (wanted("plain")) {
    report_plain(report, options, load(options.databases.front()));
  }
  const std::vector<std::string_view> scaled = {"search", "context", "beam",
                                                "soft",   "edits",   "streaming"};
  if (std::ranges::any_of(scaled, wanted)) {
    const std::vector<Subject> subjects = make_subjects(report, options);
    if (wanted("search")) {
      report_search(report, options, subjects);
    }
    if (wanted("context")) {
      report_context(report, options, subjects);
    }
    if (wanted("edits")) {
      report_edits(report, options, subjects);
    }
    if (wanted("streaming")) {
      report_streaming(report, options, subjects);
    }
    if (wanted("soft")) {
      report_soft(report, options, subjects);
    }
    if (wanted("beam")) {
      report_beam(report, options, subjects);
    }
  }
  if (!options.json.empty()) {
    std::ofstream file(options.json);
    file << report.json().dump(2) << '\n';
    if (!file.flush()) {
      throw std::runtime_error(options.json.string() + " cannot be written");
    }
  }
}

} // namespace
} // namespace phonomime::bench

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (std::ranges::find(arguments, "--help") != arguments.end()) {
    std::printf("%s", phonomime::bench::kUsage);
    return 0;
  }
  try {
    phonomime::bench::run(phonomime::bench::parse(arguments));
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "phonomime_scale_bench: %s (see --help)\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "phonomime_scale_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
