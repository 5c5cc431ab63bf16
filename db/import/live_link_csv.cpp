// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/csv_table.h"
#include "db/import/live_link_timecode.h"
#include "db/import/readers.h"
#include "db/import/sample_times.h"
#include "db/types/errors.h"
#include "db/types/live_link_columns.h"
#include "db/types/text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::size_t kFirstValue = 2; // behind Timecode and BlendShapeCount
constexpr std::size_t kLargestGrowth = 4;
constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();

// The values' names in Epic's spelling.
std::vector<std::string> read_header(const CsvTable& table) {
  const std::vector<std::string>& header = table.header();
  if (header.size() <= kFirstValue || to_lower(header[0]) != "timecode" ||
      to_lower(header[1]) != "blendshapecount") {
    table.fail("this is not the header of a Live Link Face table",
               "Timecode,BlendShapeCount,EyeBlinkLeft,...", quoted(header[0]));
  }
  std::map<std::string, std::string, std::less<>> known; // lower case -> Epic's spelling
  for (const std::string_view name : kLiveLinkColumns) {
    known.emplace(to_lower(name), name);
  }
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (std::size_t i = kFirstValue; i < header.size(); ++i) {
    const auto found = known.find(to_lower(header[i]));
    if (found == known.end()) {
      const std::vector<std::string> candidates(kLiveLinkColumns.begin(), kLiveLinkColumns.end());
      table.fail(fmt::format("column {} is not a Live Link Face value", quoted(header[i])),
                 "one of ARKit's 52 blendshapes or an angle of head or eyes", {},
                 did_you_mean(header[i], candidates));
    }
    if (!seen.insert(found->second).second) {
      table.fail(fmt::format("column {} is there twice", quoted(found->second)));
    }
    names.push_back(found->second);
  }
  return names;
}

struct Rows {
  std::vector<Timecode> timecodes;
  std::vector<long> lines;
  std::vector<float> values; // #rows by #values

  std::size_t count() const { return timecodes.size(); }
};

// A row counts all its values, or 0 of them where the face was not tracked.
void append_row(Rows& rows, const CsvTable& table) {
  const std::vector<std::string_view>& cells = table.cells();
  const std::optional<Timecode> timecode = parse_timecode(cells[0]);
  if (!timecode) {
    table.fail("the timecode cannot be read", "HH:MM:SS:FF.mmm, FF below 60", quoted(cells[0]));
  }
  const std::size_t value_count = cells.size() - kFirstValue;
  const std::optional<long> count = parse_integer(cells[1]);
  if (!count || (*count != 0 && *count != static_cast<long>(value_count))) {
    table.fail("the blendshape count is not that of the header's columns",
               std::to_string(value_count), quoted(cells[1]));
  }
  rows.timecodes.push_back(*timecode);
  rows.lines.push_back(table.line());
  for (std::size_t i = kFirstValue; i < cells.size(); ++i) {
    rows.values.push_back(*count == 0 ? kMissing : table.value(i));
  }
}

bool same_values(const Rows& rows, std::size_t a, std::size_t b) {
  const std::size_t count = rows.values.size() / rows.count();
  const auto first = rows.values.begin() + static_cast<std::ptrdiff_t>(a * count);
  const auto second = rows.values.begin() + static_cast<std::ptrdiff_t>(b * count);
  return std::equal(first, first + static_cast<std::ptrdiff_t>(count), second,
                    [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

// The frame of each row, counted from 0 in steps of the median one; a row that repeats the one
// before it has its frame.
std::vector<std::size_t> place_rows(const Rows& rows, const std::vector<double>& times_s,
                                    std::string_view where) {
  const double step_s = median_step(times_s);
  const auto fail = [&](std::size_t row, std::string what, std::string expected) {
    throw InputError({.where = at_line(where, rows.lines[row]),
                      .what = std::move(what),
                      .expected = std::move(expected),
                      .got = fmt::format("a step of {:.6g} s", times_s[row] - times_s[row - 1])});
  };
  std::vector<std::size_t> frames = {0};
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    const double elapsed = times_s[i] - times_s[i - 1];
    if (elapsed < 0.0) {
      fail(i, "the timecodes run backwards", "a timecode after the one of the row before");
    }
    const double steps = step_s > 0.0 ? std::round(elapsed / step_s) : 0.0;
    if (steps == 0.0 && !same_values(rows, i - 1, i)) {
      fail(i, "the row has the time of the row before it, but other values",
           fmt::format("a step of {:.6g} s", step_s));
    }
    if (static_cast<double>(frames.back()) + steps >
        static_cast<double>(kLargestGrowth * rows.count())) {
      fail(i, "the take has too many dropped frames", fmt::format("a step of {:.6g} s", step_s));
    }
    frames.push_back(frames.back() + static_cast<std::size_t>(steps));
  }
  return frames;
}

double fit_take(const Rows& rows, const std::vector<double>& times_s,
                const std::vector<std::size_t>& frames, double ticks, std::string_view where) {
  double resolution_ticks = 1.0;
  for (const Timecode& timecode : rows.timecodes) {
    resolution_ticks = std::min(resolution_ticks, timecode.resolution_ticks);
  }
  const FittedRate fit = fit_rate(times_s, frames, resolution_ticks / ticks);
  if (fit.largest_error_s * fit.rate_hz > 0.5) {
    throw InputError({.where = at_line(where, rows.lines[fit.worst]),
                      .what = "the timecodes are not uniform",
                      .expected = fmt::format("frames at {:.6g} Hz", fit.rate_hz),
                      .got = fmt::format("one that is {:.6g} s off", fit.largest_error_s)});
  }
  return fit.rate_hz;
}

} // namespace

MotionClip parse_live_link_csv(std::string_view text, std::string_view where) {
  CsvTable table(text, where);
  MotionClip clip;
  clip.groups = read_header(table);
  clip.channels_per_group = 1;
  Rows rows;
  while (table.next()) {
    append_row(rows, table);
  }
  if (rows.count() < 2) {
    throw InputError({.where = std::string(where),
                      .what = "the frame rate cannot be deduced from the timecodes",
                      .expected = "at least two rows",
                      .got = std::to_string(rows.count())});
  }
  const double ticks = ticks_per_second(rows.timecodes);
  const std::vector<double> times_s = elapsed_s(rows.timecodes, ticks);
  const std::vector<std::size_t> frames = place_rows(rows, times_s, where);
  if (frames.back() == 0) {
    throw InputError({.where = std::string(where), .what = "all rows have the same timecode"});
  }
  clip.rate_hz = fit_take(rows, times_s, frames, ticks, where);
  const auto value_count = static_cast<Eigen::Index>(clip.groups.size());
  clip.frames.setConstant(static_cast<Eigen::Index>(frames.back()) + 1, value_count, kMissing);
  const Eigen::Map<const FrameMatrix> values(rows.values.data(),
                                             static_cast<Eigen::Index>(rows.count()), value_count);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    clip.frames.row(static_cast<Eigen::Index>(frames[i])) =
        values.row(static_cast<Eigen::Index>(i));
  }
  return clip;
}

} // namespace phonomime
