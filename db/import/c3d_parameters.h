// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/c3d_bytes.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// The parameter section of a C3D file: named values in named groups. Names are looked up as
// "GROUP:NAME" in upper case. The bytes outlive this.
class C3dParameters {
public:
  // Walks the section that starts at byte `begin`, and sets the processor type of `bytes` by it.
  // Throws InputError for records that leave the file, overlap or do not go forward.
  C3dParameters(C3dBytes& bytes, std::size_t begin);

  std::size_t end() const { return end_; } // first byte behind the section

  bool has(std::string_view name) const { return records_.contains(name); }

  // A scalar, or the first value of an array; integers of 2 bytes are read without a sign. Nothing
  // where there is no such parameter or it is empty or text.
  std::optional<double> number(std::string_view name) const;

  // The two words of a 32-bit number, low one first (TRIAL:ACTUAL_START_FIELD), or one float.
  std::optional<double> long_number(std::string_view name) const;

  // One text or a row of texts, trimmed of the spaces and NULs around them; empty where there is
  // none.
  std::vector<std::string> texts(std::string_view name) const;

private:
  struct Record {
    int type = 0; // -1 characters, 1 bytes, 2 words, 4 floats
    std::vector<std::uint8_t> dimensions;
    std::size_t data = 0; // offset of the values
    std::size_t count = 0;
  };

  struct Unnamed { // a parameter whose group's name is not known yet
    int group = 0;
    std::string name;
    Record record;
  };

  std::size_t read_record(std::size_t offset, std::vector<Unnamed>& parameters,
                          std::map<int, std::string>& groups);
  Record read_values(std::size_t offset, std::size_t limit, std::string_view name) const;
  const Record* find(std::string_view name) const;
  std::optional<double> value(const Record& record, std::size_t i) const;

  const C3dBytes& bytes_;
  std::size_t end_ = 0;
  std::map<std::string, Record, std::less<>> records_;
};

} // namespace phonomime
