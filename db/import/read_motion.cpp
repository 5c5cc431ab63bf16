// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/csv_table.h"
#include "db/import/readers.h"
#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/text.h"

#include <fmt/format.h>

namespace phonomime {

namespace {

enum class MotionFormat { c3d, marker_csv, live_link_csv, unknown };

constexpr std::string_view kFormats = "C3D (.c3d), a marker or weight table (.csv whose first "
                                      "column is time) or a Live Link Face take "
                                      "(.csv whose first column is Timecode)";

bool looks_like_c3d(std::string_view bytes) {
  constexpr std::size_t kBlock = 512;
  return bytes.size() >= kBlock && bytes[0] >= 2 && bytes[1] == 0x50;
}

MotionFormat table_format(const std::string& bytes, const std::string& where) {
  const std::string first = to_lower(CsvTable(bytes, where).header()[0]);
  return first == "timecode" ? MotionFormat::live_link_csv
         : first == "time"   ? MotionFormat::marker_csv
                             : MotionFormat::unknown;
}

MotionFormat find_format(const std::string& suffix, const std::string& bytes,
                         const std::string& where) {
  if (suffix == ".c3d") {
    return MotionFormat::c3d;
  }
  if (suffix == ".csv") {
    return table_format(bytes, where);
  }
  if (looks_like_c3d(bytes)) {
    return MotionFormat::c3d;
  }
  try {
    return table_format(bytes, where);
  } catch (const InputError&) {
    return MotionFormat::unknown;
  }
}

} // namespace

MotionClip read_motion(const std::filesystem::path& path) {
  const std::string where = path.string();
  const std::string bytes = read_file(path);
  switch (find_format(to_lower(path.extension().string()), bytes, where)) {
  case MotionFormat::c3d:
    return parse_c3d(bytes, where);
  case MotionFormat::marker_csv:
    return parse_marker_csv(bytes, where);
  case MotionFormat::live_link_csv:
    return parse_live_link_csv(bytes, where);
  case MotionFormat::unknown:
    break;
  }
  throw InputError({.where = where,
                    .what = "the file is in no known motion format",
                    .expected = std::string(kFormats)});
}

} // namespace phonomime
