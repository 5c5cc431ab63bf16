// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/c3d_parameters.h"

#include "db/types/text.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::string_view kSection = "the parameter section";

std::string upper(std::string_view name) {
  std::string result(name);
  for (char& c : result) {
    c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return result;
}

// Labels are ASCII by the format; other bytes are taken as Latin-1.
std::string to_utf8(std::string_view text) {
  if (is_valid_utf8(text)) {
    return std::string(text);
  }
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20) {
      result += '?';
    } else if (byte < 0x80) {
      result += c;
    } else {
      result += static_cast<char>(0xC0 | byte >> 6);
      result += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return result;
}

std::string_view trim_padding(std::string_view text) {
  constexpr std::string_view kPadding{" \t\r\n\0", 5};
  const std::size_t begin = text.find_first_not_of(kPadding);
  return begin == std::string_view::npos
             ? std::string_view()
             : text.substr(begin, text.find_last_not_of(kPadding) - begin + 1);
}

} // namespace

C3dParameters::C3dParameters(C3dBytes& bytes, std::size_t begin) : bytes_(bytes) {
  const int processor = bytes.byte(begin + 3, kSection);
  if (processor < static_cast<int>(C3dProcessor::intel) ||
      processor > static_cast<int>(C3dProcessor::mips)) {
    bytes.fail("the parameter section names an unknown processor type",
               "84 (Intel), 85 (DEC) or 86 (MIPS)", std::to_string(processor),
               "The file is damaged, or not a C3D file.");
  }
  bytes.set_processor(static_cast<C3dProcessor>(processor));

  std::vector<Unnamed> parameters;
  std::map<int, std::string> groups;
  // A section that fills its blocks to the last byte may do without an end mark.
  const std::size_t full = begin + C3dBytes::kBlock * bytes.byte(begin + 2, kSection);
  std::size_t offset = begin + 4;
  while (offset != 0 && offset != full) {
    offset = read_record(offset, parameters, groups);
  }
  for (Unnamed& parameter : parameters) {
    const auto group = groups.find(parameter.group);
    if (group == groups.end()) {
      continue; // of a nameless group: nothing that anyone could ask for
    }
    std::string name = group->second + ":" + parameter.name;
    if (!records_.emplace(name, std::move(parameter.record)).second) {
      bytes.fail(fmt::format("parameter {} is there twice", quoted(name)));
    }
  }
}

// A group or a parameter: length of its name (negative = locked), its group's number (negative =
// this is the group itself), its name, and the way to the next record (0 = this is the last one).
// Gives the offset of the next one, 0 behind the last.
std::size_t C3dParameters::read_record(std::size_t offset, std::vector<Unnamed>& parameters,
                                       std::map<int, std::string>& groups) {
  const auto name_length =
      static_cast<std::size_t>(std::abs(static_cast<std::int8_t>(bytes_.byte(offset, kSection))));
  if (name_length == 0) {
    end_ = offset + 1;
    return 0;
  }
  const int group = static_cast<std::int8_t>(bytes_.byte(offset + 1, kSection));
  const std::string name =
      to_utf8(upper(trim_padding(bytes_.slice(offset + 2, name_length, kSection))));
  const std::size_t link = offset + 2 + name_length;
  const std::size_t step = bytes_.word(link, kSection);
  if (step == 1) {
    bytes_.fail(fmt::format("the record of {} in the parameter section leads back to itself",
                            quoted(name)));
  }
  const std::size_t next = step == 0 ? 0 : link + step;
  const std::size_t limit = step == 0 ? bytes_.size() : next;
  if (limit > bytes_.size()) {
    bytes_.fail(fmt::format("the record of {} in the parameter section leads outside the file",
                            quoted(name)),
                fmt::format("at most {} bytes", bytes_.size()), std::to_string(next),
                "The file seems to be cut off or damaged.");
  }
  end_ = link + 2;
  if (group < 0) {
    if (!groups.emplace(-group, name).second) {
      bytes_.fail(fmt::format("group number {} of the parameter section is there twice", -group));
    }
  } else if (group > 0) {
    Record record = read_values(link + 2, limit, name);
    end_ = record.data + record.count * static_cast<std::size_t>(std::abs(record.type));
    parameters.push_back({group, name, std::move(record)});
  } else {
    bytes_.fail(fmt::format("parameter {} belongs to group 0", quoted(name)),
                "a group number from 1");
  }
  return next;
}

C3dParameters::Record C3dParameters::read_values(std::size_t offset, std::size_t limit,
                                                 std::string_view name) const {
  Record record;
  record.type = static_cast<std::int8_t>(bytes_.byte(offset, kSection));
  if (record.type != -1 && record.type != 1 && record.type != 2 && record.type != 4) {
    bytes_.fail(fmt::format("parameter {} is of an unknown type", quoted(name)), "-1, 1, 2 or 4",
                std::to_string(record.type));
  }
  const std::size_t dimension_count = bytes_.byte(offset + 1, kSection);
  if (dimension_count > 7) {
    bytes_.fail(fmt::format("parameter {} has too many dimensions", quoted(name)), "at most 7",
                std::to_string(dimension_count));
  }
  record.data = offset + 2 + dimension_count;
  record.count = 1;
  const auto item_bytes = static_cast<std::size_t>(std::abs(record.type));
  for (const char c : bytes_.slice(offset + 2, dimension_count, kSection)) {
    record.dimensions.push_back(static_cast<std::uint8_t>(c));
    record.count *= record.dimensions.back(); // at most 255^7, which fits in 64 bits
  }
  if (record.data > limit || record.count > (limit - record.data) / item_bytes) {
    bytes_.fail(fmt::format("the values of parameter {} do not fit into its record", quoted(name)),
                fmt::format("at most {} bytes", limit - std::min(limit, record.data)),
                fmt::format("{} values of {} bytes", record.count, item_bytes));
  }
  return record;
}

const C3dParameters::Record* C3dParameters::find(std::string_view name) const {
  const auto found = records_.find(name);
  return found == records_.end() ? nullptr : &found->second;
}

std::optional<double> C3dParameters::value(const Record& record, std::size_t i) const {
  if (i >= record.count) {
    return std::nullopt;
  }
  switch (record.type) {
  case 1:
    return bytes_.byte(record.data + i, kSection);
  case 2:
    return bytes_.word(record.data + 2 * i, kSection);
  case 4:
    return static_cast<double>(bytes_.real(record.data + 4 * i, kSection));
  default:
    return std::nullopt;
  }
}

std::optional<double> C3dParameters::number(std::string_view name) const {
  const Record* record = find(name);
  return record == nullptr ? std::nullopt : value(*record, 0);
}

std::optional<double> C3dParameters::long_number(std::string_view name) const {
  const Record* record = find(name);
  if (record == nullptr) {
    return std::nullopt;
  }
  if (record->type == 2 && record->count == 2) {
    return *value(*record, 0) + 65536.0 * *value(*record, 1);
  }
  return value(*record, 0);
}

std::vector<std::string> C3dParameters::texts(std::string_view name) const {
  const Record* record = find(name);
  std::vector<std::string> result;
  if (record == nullptr || record->type != -1 || record->count == 0 ||
      record->dimensions.size() > 2) {
    return result;
  }
  const std::size_t length = record->dimensions.empty() ? 1 : record->dimensions[0];
  for (std::size_t i = 0; i < record->count / length; ++i) {
    const std::string_view text = bytes_.slice(record->data + i * length, length, kSection);
    result.push_back(to_utf8(trim_padding(text)));
  }
  return result;
}

} // namespace phonomime
