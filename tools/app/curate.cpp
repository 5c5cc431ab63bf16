// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/curate.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/text.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <tuple>

#include <pwd.h>
#include <unistd.h>

#include <fmt/format.h>

namespace phonomime {

namespace {

std::string user_name() {
  if (const passwd* user = getpwuid(geteuid()); user != nullptr && *user->pw_name != '\0') {
    return user->pw_name;
  }
  const char* name = std::getenv("USER");
  return name != nullptr && *name != '\0' ? name : "unknown";
}

// The first field of a line of comma separated values.
std::string first_csv_field(std::string_view line) {
  if (!line.starts_with('"')) {
    return std::string(line.substr(0, line.find(',')));
  }
  std::string field;
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (i + 1 >= line.size() || line[i + 1] != '"') {
        break;
      }
      ++i;
    }
    field += line[i];
  }
  return field;
}

std::string read_keys(const std::filesystem::path& from) {
  if (from != "-") {
    return read_file(from);
  }
  return {std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()};
}

void check_text(const char* option, const std::string& text) {
  const bool control = std::ranges::any_of(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
  if (!is_valid_utf8(text) || control) {
    throw UsageError({.where = option,
                      .what = "is not plain text on one line",
                      .got = quoted(text),
                      .remedy = "Leave out line breaks and control characters."});
  }
}

CurationRequest request_of(const CurateOptions& options, const MotionDatabase& database) {
  CurationRequest request{.action = options.action,
                          .by = options.by.empty() ? user_name() : options.by,
                          .reason = std::string(trim(options.reason)),
                          .dry_run = options.dry_run};
  check_text("--by", request.by);
  check_text("--reason", request.reason);
  if (options.action == CurationAction::undo) {
    return request;
  }
  if (request.reason.empty()) {
    throw UsageError({.where = "--reason",
                      .what = "is missing",
                      .expected = "why these nodes are pruned or restored, in a few words",
                      .remedy = "The journal keeps it."});
  }
  if (options.keys.empty() && options.from.empty() && !options.filter) {
    throw UsageError({.what = "no motion node is named",
                      .expected = "keys, --from FILE, or options that choose nodes"});
  }
  request.keys = options.keys;
  request.where.resize(request.keys.size());
  if (!options.from.empty()) {
    const std::string name = options.from == "-" ? "standard input" : options.from.string();
    for (TypedKey& typed : parse_keys(read_keys(options.from), name)) {
      request.keys.push_back(std::move(typed.key));
      request.where.push_back(std::move(typed.where));
    }
  }
  if (options.filter) {
    NodeFilter filter = *options.filter;
    filter.pruned = options.action == CurationAction::restore;
    for (NodeRecord& node : database.list_nodes(filter)) {
      request.keys.push_back(std::move(node.key));
    }
  }
  return request;
}

void compare(const char* kind, const std::map<Coverage::Cell, std::int64_t>& before,
             const std::map<Coverage::Cell, std::int64_t>& after, std::int64_t thin_below,
             std::vector<ThinPart>& thin) {
  for (const auto& [cell, count] : before) {
    const auto now = after.find(cell);
    const std::int64_t left = now == after.end() ? 0 : now->second;
    if (left != count && std::min(left, count) < thin_below) {
      thin.push_back({.kind = kind,
                      .speaker = cell.speaker,
                      .name = cell.name,
                      .before = count,
                      .after = left});
    }
  }
}

} // namespace

std::vector<TypedKey> parse_keys(std::string_view text, std::string_view where) {
  std::vector<TypedKey> keys;
  const std::vector<std::string_view> lines = split_lines(text);
  bool by_commas = false;
  bool first = true;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = trim(lines[i]);
    if (line.empty() || line.front() == '#') {
      continue;
    }
    const bool heads =
        first && (line == "key" || line.starts_with("key\t") || line.starts_with("key,"));
    first = false;
    if (heads) {
      by_commas = line.starts_with("key,");
      continue;
    }
    std::string key =
        by_commas ? first_csv_field(line) : std::string(line.substr(0, line.find('\t')));
    keys.push_back({.key = std::string(trim(key)), .where = at_line(std::string(where), i + 1)});
  }
  return keys;
}

CurateReport run_curation(const CurateOptions& options) {
  if (options.thin_below < 0) {
    throw UsageError({.where = "--thin",
                      .what = "is out of range",
                      .expected = "0 or more nodes",
                      .got = fmt::format("{}", options.thin_below)});
  }
  CurateReport report;
  CurationRequest request;
  {
    // Whoever asks for what cannot be done is told so before the database is opened for writing,
    // which would make a new one.
    const MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_only);
    request = request_of(options, database);
  }
  MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_write);
  report.outcome = database.curate(request);
  const Coverage& before = report.outcome.before;
  const Coverage& after = report.outcome.after;
  compare("phoneme", before.phonemes, after.phonemes, options.thin_below, report.thin);
  compare("emotion", before.emotions, after.emotions, options.thin_below, report.thin);
  compare("triphone", before.triphones, after.triphones, options.thin_below, report.thin);
  std::ranges::stable_sort(report.thin, {}, [](const ThinPart& part) {
    return std::tuple(part.kind == "phoneme" ? 0 : part.kind == "emotion" ? 1 : 2, part.after);
  });
  return report;
}

} // namespace phonomime
