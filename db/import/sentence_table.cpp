// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/sentence_table.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

enum Column { id, text, speaker, emotion, motion, alignment, audio, start, end, column_count };
using Names = std::array<std::string_view, column_count>;
constexpr Names kColumns = {"id",        "text",  "speaker", "emotion", "motion",
                            "alignment", "audio", "start",   "end"};
constexpr std::array kRequired = {id, motion, alignment};

[[noreturn]] void fail(std::string where, std::string what, std::string remedy = {}) {
  throw InputError(
      {.where = std::move(where), .what = std::move(what), .remedy = std::move(remedy)});
}

// Field of each column, -1 where the table does not have it.
std::array<int, column_count> parse_header(std::string_view line, const std::string& where) {
  std::array<int, column_count> field_of;
  field_of.fill(-1);
  const std::vector<std::string_view> fields = split_fields(line, '\t');
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string_view name = trim(fields[i]);
    const auto column = std::find(kColumns.begin(), kColumns.end(), name);
    if (column == kColumns.end()) {
      const std::vector<std::string> known(kColumns.begin(), kColumns.end());
      throw InputError({.where = where,
                        .what = fmt::format("unknown column {}", quoted(name)),
                        .expected = fmt::format("{}, separated by tabs", fmt::join(kColumns, ", ")),
                        .remedy = did_you_mean(name, known)});
    }
    int& field = field_of[static_cast<std::size_t>(column - kColumns.begin())];
    if (field >= 0) {
      fail(where, fmt::format("column {} is there twice", quoted(name)));
    }
    field = static_cast<int>(i);
  }
  for (const Column column : kRequired) {
    if (field_of[column] < 0) {
      throw InputError({.where = where,
                        .what = fmt::format("column \"{}\" is missing", kColumns[column]),
                        .expected = "a header line with at least id, motion and alignment, "
                                    "separated by tabs",
                        .got = quoted(line)});
    }
  }
  return field_of;
}

std::optional<double> parse_time(std::string_view field, std::string_view column,
                                 const std::string& where) {
  if (field.empty()) {
    return std::nullopt;
  }
  const std::optional<double> time_s = parse_number(field);
  if (!time_s || *time_s < 0.0) {
    throw InputError({.where = where,
                      .what = fmt::format("{} is not a time", column),
                      .expected = "seconds, at least 0",
                      .got = quoted(field)});
  }
  return time_s;
}

SentenceRow parse_row(std::string_view line, const std::array<int, column_count>& field_of,
                      std::size_t header_fields, std::string_view default_speaker,
                      const std::string& where) {
  const std::vector<std::string_view> fields = split_fields(line, '\t');
  if (fields.size() > header_fields) {
    throw InputError({.where = where,
                      .what = "line has more fields than the header",
                      .expected = fmt::format("{}", header_fields),
                      .got = fmt::format("{}", fields.size())});
  }
  const auto field = [&](Column column) -> std::string_view {
    const int place = field_of[column];
    return place < 0 || place >= static_cast<int>(fields.size())
               ? std::string_view()
               : trim(fields[static_cast<std::size_t>(place)]);
  };
  for (const Column column : kRequired) {
    if (field(column).empty()) {
      fail(where, fmt::format("{} is empty", kColumns[column]));
    }
  }
  SentenceRow row{.id = std::string(field(id)),
                  .text = std::string(field(text)),
                  .speaker = std::string(field(speaker).empty() ? default_speaker : field(speaker)),
                  .emotion = std::string(field(emotion).empty() ? kNeutral : field(emotion)),
                  .motion = std::string(field(motion)),
                  .alignment = std::string(field(alignment)),
                  .audio = std::string(field(audio)),
                  .start_s = parse_time(field(start), "start", where),
                  .end_s = parse_time(field(end), "end", where)};
  check_key_part(row.id, "id", where);
  check_key_part(row.emotion, "emotion", where);
  check_key_part(row.speaker, "speaker", where);
  if (row.end_s && *row.end_s <= row.start_s.value_or(0.0)) {
    throw InputError({.where = where,
                      .what = "sentence ends before it starts",
                      .expected = "start < end",
                      .got = fmt::format("{} and {}", format_number(row.start_s.value_or(0.0)),
                                         format_number(*row.end_s))});
  }
  return row;
}

} // namespace

void check_key_part(std::string_view name, std::string_view what, std::string_view where) {
  const auto is_bad = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte <= 0x20 || byte == 0x7f || c == '/' || c == '#';
  };
  if (name.empty() || std::any_of(name.begin(), name.end(), is_bad)) {
    throw InputError({.where = std::string(where),
                      .what = fmt::format("{} {} cannot stand in a node's key", what, quoted(name)),
                      .expected = "a name without \"/\", \"#\" and white space"});
  }
}

std::vector<SentenceRow> parse_sentence_table(std::string_view table, std::string_view where,
                                              std::string_view default_speaker) {
  const std::vector<std::string_view> lines = split_lines(table);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!is_valid_utf8(lines[i])) {
      fail(at_line(where, static_cast<long>(i + 1)), "line is not UTF-8 text",
           "Save the table as UTF-8.");
    }
  }
  if (lines.empty() || trim(lines.front()).empty()) {
    fail(at_line(where, 1), "table has no header line");
  }
  const std::array<int, column_count> field_of = parse_header(lines.front(), at_line(where, 1));
  const std::size_t header_fields = split_fields(lines.front(), '\t').size();
  std::vector<SentenceRow> rows;
  std::map<std::tuple<std::string, std::string, std::string>, long> first_line;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (trim(lines[i]).empty()) {
      continue;
    }
    const auto line = static_cast<long>(i + 1);
    SentenceRow row =
        parse_row(lines[i], field_of, header_fields, default_speaker, at_line(where, line));
    row.line = line;
    const auto [earlier, is_new] =
        first_line.emplace(std::tuple(row.speaker, row.emotion, row.id), line);
    if (!is_new) {
      fail(at_line(where, line),
           fmt::format("sentence {}/{}/{} is there twice, first at line {}", row.speaker,
                       row.emotion, row.id, earlier->second),
           "Give each sentence of a speaker and an emotion an id of its own.");
    }
    rows.push_back(std::move(row));
  }
  if (rows.empty()) {
    fail(std::string(where), "table has no sentences");
  }
  return rows;
}

} // namespace phonomime
