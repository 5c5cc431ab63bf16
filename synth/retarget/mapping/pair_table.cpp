// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/pair_table.h"

#include "db/types/errors.h"
#include "db/types/tab_table.h"
#include "db/types/text.h"

#include <array>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace phonomime {
namespace {

constexpr std::string_view kFrame = "frame";
constexpr std::string_view kNote = "note";

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
  std::vector<std::string_view> columns = {kFrame, kNote};
  columns.insert(columns.end(), face_shapes.begin(), face_shapes.end());
  constexpr std::array<std::size_t, 1> kRequired = {0};
  TabTable rows(text, where, columns, kRequired, {.comments = true});
  PairTable table;
  std::vector<std::size_t> shapes; // columns that the table has
  for (std::size_t c = 2; c < columns.size(); ++c) {
    if (rows.has(c)) {
      shapes.push_back(c);
      table.shapes.emplace_back(columns[c]);
    }
  }
  std::vector<double> weights;
  std::set<std::string, std::less<>> frames;
  while (rows.next()) {
    PairTable::Row row{.frame = parse_frame(rows.field(0), rows.where()),
                       .note = std::string(rows.field(1)),
                       .line = rows.line()};
    if (!frames.insert(row.frame.text()).second) {
      throw InputError(
          {.where = rows.where(), .what = "frame " + quoted(row.frame.text()) + " is there twice"});
    }
    for (std::size_t s = 0; s < shapes.size(); ++s) {
      weights.push_back(parse_weight(rows.field(shapes[s]), table.shapes[s], rows.where()));
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
