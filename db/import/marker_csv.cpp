// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/csv_table.h"
#include "db/import/readers.h"
#include "db/import/sample_times.h"
#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr double kStepShare = 0.1;       // of a frame that a step may be off
constexpr double kStepRounding_s = 1e-3; // or this, where times are written in milliseconds
constexpr double kLargestStepShare = 0.45;

struct Columns {
  std::vector<std::string> groups;
  int channels_per_group = 1;
};

// "lm61_x" gives "lm61"; nothing where the column does not end so.
std::optional<std::string_view> stem(std::string_view column, char axis) {
  const std::size_t size = column.size();
  if (size < 3 || column[size - 2] != '_' || to_lower(column.substr(size - 1))[0] != axis) {
    return std::nullopt;
  }
  return column.substr(0, size - 2);
}

// Markers where some column `<name>_x` is followed by `<name>_y`; else weights.
bool holds_markers(const std::vector<std::string>& header) {
  for (std::size_t i = 1; i + 1 < header.size(); ++i) {
    if (stem(header[i], 'x') && stem(header[i], 'x') == stem(header[i + 1], 'y')) {
      return true;
    }
  }
  return false;
}

Columns read_header(const CsvTable& table) {
  const std::vector<std::string>& header = table.header();
  if (to_lower(header[0]) != "time") {
    table.fail("the first column is not the time",
               "a header `time,<group>_x,<group>_y,<group>_z,...` "
               "or `time,<name>,...`",
               quoted(header[0]));
  }
  if (header.size() < 2) {
    table.fail("the table has no column beside the time", "at least one marker or weight");
  }
  Columns columns;
  columns.channels_per_group = holds_markers(header) ? 3 : 1;
  const std::size_t step = static_cast<std::size_t>(columns.channels_per_group);
  for (std::size_t i = 1; i < header.size(); i += step) {
    std::string name = header[i];
    if (step == 3) {
      const std::optional<std::string_view> x = stem(header[i], 'x');
      if (!x || i + 2 >= header.size() || stem(header[i + 1], 'y') != x ||
          stem(header[i + 2], 'z') != x) {
        table.fail("the columns of a marker are not together",
                   "`<group>_x`, `<group>_y` and `<group>_z`, one after the other",
                   quoted(header[i]));
      }
      name = *x;
    }
    if (name.empty()) {
      table.fail(fmt::format("column {} has no name", i + 1));
    }
    columns.groups.push_back(std::move(name));
  }
  std::set<std::string_view> seen;
  for (const std::string& name : columns.groups) {
    if (!seen.insert(name).second) {
      table.fail(fmt::format("{} is there twice", quoted(name)), {}, {}, "Rename one of them.");
    }
  }
  return columns;
}

// A marker of which one coordinate is missing is missing.
void append_values(const CsvTable& table, int channels_per_group, std::vector<float>& values) {
  const auto step = static_cast<std::size_t>(channels_per_group);
  for (std::size_t i = 1; i < table.cells().size(); i += step) {
    const std::size_t begin = values.size();
    bool there = true;
    for (std::size_t axis = 0; axis < step; ++axis) {
      values.push_back(table.value(i + axis));
      there = there && !std::isnan(values.back());
    }
    if (!there) {
      std::fill(values.begin() + static_cast<std::ptrdiff_t>(begin), values.end(),
                std::numeric_limits<float>::quiet_NaN());
    }
  }
}

struct Times {
  std::vector<double> times_s;
  std::vector<long> lines;
  double resolution_s = 1.0;

  void append(const CsvTable& table) {
    const std::string_view cell = table.cells()[0];
    const std::optional<double> time_s = parse_number(cell);
    if (!time_s) {
      table.fail("the time is not a number", "seconds", quoted(cell));
    }
    if (!times_s.empty() && *time_s <= times_s.back()) {
      table.fail("the times run backwards or stand still",
                 fmt::format("a time after {} s", times_s.back()), fmt::format("{} s", *time_s));
    }
    times_s.push_back(*time_s);
    lines.push_back(table.line());
    resolution_s = std::min(resolution_s, written_resolution(cell));
  }
};

double deduce_rate(const Times& times, std::string_view where) {
  const std::vector<double>& t = times.times_s;
  if (t.size() < 2) {
    throw InputError({.where = std::string(where),
                      .what = "the frame rate cannot be deduced from the times",
                      .expected = "at least two rows",
                      .got = std::to_string(t.size())});
  }
  const double step_s = median_step(t);
  const double tolerance_s =
      std::min(std::max(kStepShare * step_s, kStepRounding_s), kLargestStepShare * step_s);
  const auto fail = [&](std::size_t row, double expected_s, double got_s) {
    throw InputError(
        {.where = at_line(where, times.lines[row]),
         .what = "the times are not uniform",
         .expected = fmt::format("a row every {:.6g} s, so {:.6g} s here", step_s, expected_s),
         .got = fmt::format("{:.6g} s", got_s),
         .remedy = "Resample the table, or write missing rows with empty fields."});
  };
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (std::abs(t[i] - t[i - 1] - step_s) > tolerance_s) {
      fail(i, t[i - 1] + step_s, t[i]);
    }
  }
  std::vector<std::size_t> frames(t.size());
  std::iota(frames.begin(), frames.end(), std::size_t{0});
  const FittedRate fit = fit_rate(t, frames, times.resolution_s);
  if (fit.largest_error_s > kLargestStepShare * step_s) {
    fail(fit.worst, t[0] + static_cast<double>(fit.worst) / fit.rate_hz, t[fit.worst]);
  }
  return fit.rate_hz;
}

} // namespace

MotionClip parse_marker_csv(std::string_view text, std::string_view where) {
  CsvTable table(text, where);
  Columns columns = read_header(table);
  Times times;
  std::vector<float> values;
  while (table.next()) {
    times.append(table);
    append_values(table, columns.channels_per_group, values);
  }
  MotionClip clip;
  clip.rate_hz = deduce_rate(times, where);
  clip.start_s = times.times_s[0];
  clip.groups = std::move(columns.groups);
  clip.channels_per_group = columns.channels_per_group;
  clip.unit_mm = columns.channels_per_group == 3 ? 1.0 : 0.0;
  clip.frames =
      Eigen::Map<const FrameMatrix>(values.data(), static_cast<Eigen::Index>(times.times_s.size()),
                                    static_cast<Eigen::Index>(table.header().size() - 1));
  return clip;
}

} // namespace phonomime
