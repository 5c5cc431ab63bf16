// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/readers.h"
#include "db/import/unicode.h"
#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/text.h"

#include <algorithm>

#include <fmt/format.h>

namespace phonomime {

namespace {

enum class AlignmentFormat { xlabel, htk, textgrid, unknown };

constexpr std::string_view kFormats =
    "Festival/xlabel (.lab), HTK labels (.lab, .htk) or Praat TextGrid (.TextGrid)";

bool holds_rows_of_times(const std::vector<std::string_view>& lines) {
  for (const std::string_view line : lines) {
    const std::vector<std::string_view> words = split_words(line);
    if (!words.empty()) {
      return line == "#!MLF!#" ||
             (words.size() >= 2 && parse_number(words[0]) && parse_number(words[1]));
    }
  }
  return false;
}

AlignmentFormat by_content(std::string_view bytes, std::string_view where) {
  constexpr std::size_t kHeadBytes = 200;
  if (bytes.starts_with("ooBinaryFile")) {
    return AlignmentFormat::textgrid;
  }
  const std::string text = decode_text(bytes, where);
  if (text.substr(0, kHeadBytes).find("ooTextFile") != std::string::npos) {
    return AlignmentFormat::textgrid;
  }
  const std::vector<std::string_view> lines = split_lines(text);
  if (std::ranges::any_of(lines, [](std::string_view line) { return trim(line) == "#"; })) {
    return AlignmentFormat::xlabel;
  }
  return holds_rows_of_times(lines) ? AlignmentFormat::htk : AlignmentFormat::unknown;
}

AlignmentFormat find_format(const std::string& suffix, std::string_view bytes,
                            std::string_view where) {
  if (suffix == ".textgrid") {
    return AlignmentFormat::textgrid;
  }
  if (suffix == ".htk" || suffix == ".mlf") {
    return AlignmentFormat::htk;
  }
  if (suffix == ".phn" || suffix == ".wrd") {
    return AlignmentFormat::unknown; // TIMIT counts in samples of a rate that the file does not say
  }
  const AlignmentFormat format = by_content(bytes, where);
  return format == AlignmentFormat::unknown && suffix == ".lab" ? AlignmentFormat::xlabel : format;
}

} // namespace

Alignment read_alignment(const std::filesystem::path& path, const AlignmentOptions& options) {
  const std::string where = path.string();
  const std::string bytes = read_file(path);
  switch (find_format(to_lower(path.extension().string()), bytes, where)) {
  case AlignmentFormat::xlabel:
    return parse_xlabel(bytes, where);
  case AlignmentFormat::htk:
    return parse_htk_label(bytes, where);
  case AlignmentFormat::textgrid:
    return parse_textgrid(bytes, where, options.tier);
  case AlignmentFormat::unknown:
    break;
  }
  throw InputError({.where = where,
                    .what = "the file is in no known alignment format",
                    .expected = std::string(kFormats)});
}

} // namespace phonomime
