// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/pair_table.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace phonomime {
namespace {

constexpr std::string_view kFrame = "frame";
constexpr std::string_view kNote = "note";

// What the columns of a table are, from its header line.
struct Columns {
  std::size_t frame = 0;
  std::optional<std::size_t> note;
  std::vector<std::size_t> shapes;
  std::size_t count = 0;
};

Columns read_header(std::string_view line, const std::string& where,
                    std::span<const std::string> face_shapes, std::vector<std::string>& shapes) {
  Columns columns;
  std::optional<std::size_t> frame;
  std::set<std::string, std::less<>> seen;
  for (const std::string_view field : split_fields(line, '\t')) {
    const std::string name(trim(field));
    if (!seen.insert(name).second) {
      throw InputError({.where = where, .what = "column " + quoted(name) + " is there twice"});
    }
    if (name == kFrame) {
      frame = columns.count;
    } else if (name == kNote) {
      columns.note = columns.count;
    } else if (std::ranges::find(face_shapes, name) != face_shapes.end()) {
      shapes.push_back(name);
      columns.shapes.push_back(columns.count);
    } else {
      throw InputError({.where = where,
                        .what = "column " + quoted(name) + " is no shape of the face",
                        .remedy = did_you_mean(name, face_shapes)});
    }
    ++columns.count;
  }
  if (!frame) {
    throw InputError({.where = where,
                      .what = "the header line has no column " + quoted(kFrame),
                      .expected = "frame, note and the names of shapes, separated by tabs",
                      .got = quoted(line)});
  }
  columns.frame = *frame;
  return columns;
}

FrameName parse_frame(std::string_view field, const std::string& where) {
  const std::size_t at = field.rfind('@');
  const std::optional<double> time =
      at == std::string_view::npos ? std::nullopt : parse_number(field.substr(at + 1));
  if (!time || *time < 0.0 || at == 0) {
    throw InputError({.where = where,
                      .what = quoted(field) + " does not name a frame",
                      .expected = "speaker/emotion/sentence#order@seconds"});
  }
  return {.node = std::string(field.substr(0, at)), .time_s = *time};
}

double parse_weight(std::string_view field, const std::string& shape, const std::string& where) {
  field = trim(field);
  if (field.empty()) {
    return 0.0;
  }
  const std::optional<double> weight = parse_number(field);
  if (!weight || *weight < 0.0 || *weight > 1.0) {
    throw InputError({.where = where,
                      .what = "the weight of " + quoted(shape) + " is out of range",
                      .expected = "a number from 0 to 1",
                      .got = quoted(field)});
  }
  return *weight;
}

} // namespace

std::string FrameName::text() const {
  return fmt::format("{}@{:.3f}", node, time_s);
}

PairTable parse_pair_table(std::string_view text, std::string_view where,
                           std::span<const std::string> face_shapes) {
  PairTable table;
  std::optional<Columns> columns;
  std::vector<double> weights;
  std::set<std::string, std::less<>> frames;
  long line_number = 0;
  for (const std::string_view line : split_lines(text)) {
    ++line_number;
    if (trim(line).empty() || line.front() == '#') {
      continue;
    }
    const std::string place = at_line(where, line_number);
    if (!columns) {
      columns = read_header(line, place, face_shapes, table.shapes);
      continue;
    }
    auto fields = split_fields(line, '\t');
    if (fields.size() > columns->count) {
      throw InputError({.where = place,
                        .what = "the line has more fields than the header line",
                        .expected = std::to_string(columns->count),
                        .got = std::to_string(fields.size())});
    }
    fields.resize(columns->count); // what is missing at the end is empty
    PairTable::Row row{
        .frame = parse_frame(trim(fields[columns->frame]), place), .note = {}, .line = line_number};
    if (columns->note) {
      row.note = trim(fields[*columns->note]);
    }
    if (!frames.insert(row.frame.text()).second) {
      throw InputError(
          {.where = place, .what = "frame " + quoted(row.frame.text()) + " is there twice"});
    }
    for (std::size_t s = 0; s < columns->shapes.size(); ++s) {
      weights.push_back(parse_weight(fields[columns->shapes[s]], table.shapes[s], place));
    }
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty() || table.shapes.empty()) {
    throw InputError({.where = std::string(where),
                      .what = "the table holds no pairs",
                      .expected = "a header line with shapes, and a line for each frame"});
  }
  table.weights = Eigen::Map<const FrameMatrixD>(weights.data(), std::ssize(table.rows),
                                                 std::ssize(table.shapes));
  return table;
}

std::string format_pair_table(const PairTable& table) {
  std::string text = "frame\tnote";
  for (const std::string& shape : table.shapes) {
    text += '\t' + shape;
  }
  text += '\n';
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    text += table.rows[i].frame.text() + '\t' + table.rows[i].note;
    for (Eigen::Index s = 0; s < table.weights.cols(); ++s) {
      const double weight = table.weights(static_cast<Eigen::Index>(i), s);
      text += '\t' + (weight == 0.0 ? std::string("0") : fmt::format("{:.4f}", weight));
    }
    text += '\n';
  }
  return text;
}

} // namespace phonomime
