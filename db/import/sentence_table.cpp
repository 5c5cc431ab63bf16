// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/sentence_table.h"

#include "db/types/errors.h"
#include "db/types/tab_table.h"
#include "db/types/text.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include <fmt/format.h>

namespace phonomime {

namespace {

enum Column : std::size_t { id, text, speaker, emotion, motion, alignment, audio, start, end };
constexpr std::array<std::string_view, 9> kColumns = {
    "id", "text", "speaker", "emotion", "motion", "alignment", "audio", "start", "end"};
constexpr std::array<std::size_t, 3> kRequired = {id, motion, alignment};

[[noreturn]] void fail(std::string where, std::string what, std::string remedy = {}) {
  throw InputError(
      {.where = std::move(where), .what = std::move(what), .remedy = std::move(remedy)});
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

SentenceRow parse_row(const TabTable& table, std::string_view default_speaker) {
  const std::string where = table.where();
  const auto text_of = [&](Column column, std::string_view otherwise = {}) {
    const std::string_view field = table.field(column);
    return std::string(field.empty() ? otherwise : field);
  };
  SentenceRow row{.id = text_of(id),
                  .text = text_of(text),
                  .speaker = text_of(speaker, default_speaker),
                  .emotion = text_of(emotion, kNeutral),
                  .motion = text_of(motion),
                  .alignment = text_of(alignment),
                  .audio = text_of(audio),
                  .start_s = parse_time(table.field(start), "start", where),
                  .end_s = parse_time(table.field(end), "end", where),
                  .line = table.line()};
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

std::vector<SentenceRow> parse_sentence_table(std::string_view text, std::string_view where,
                                              std::string_view default_speaker) {
  TabTable table(text, where, kColumns, kRequired);
  std::vector<SentenceRow> rows;
  std::map<std::tuple<std::string, std::string, std::string>, long> first_line;
  while (table.next()) {
    SentenceRow row = parse_row(table, default_speaker);
    const auto [earlier, is_new] =
        first_line.emplace(std::tuple(row.speaker, row.emotion, row.id), row.line);
    if (!is_new) {
      fail(table.where(),
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
