// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/c3d_bytes.h"

#include "db/types/errors.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace phonomime {

namespace {

const unsigned char* data(std::string_view bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

} // namespace

// Sign, 8 bits of exponent (bias 128), 23 bits of fraction behind a hidden 0.1 (binary), in two
// little-endian words of which the first is the more significant. The smallest ones lie below
// IEEE's normal floats, the largest fit.
float decode_dec_float(const unsigned char* bytes) {
  const std::uint32_t bits = static_cast<std::uint32_t>(decode_word<C3dProcessor::dec>(bytes))
                                 << 16 |
                             decode_word<C3dProcessor::dec>(bytes + 2);
  const bool negative = bits >> 31 != 0;
  const int exponent = static_cast<int>(bits >> 23 & 0xFF);
  if (exponent == 0) {
    return negative ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
  }
  const double fraction = (1u << 23 | (bits & 0x7FFFFF)) / static_cast<double>(1u << 24);
  const auto value = static_cast<float>(std::ldexp(fraction, exponent - 128));
  return negative ? -value : value;
}

std::string_view C3dBytes::slice(std::size_t offset, std::size_t count,
                                 std::string_view what) const {
  if (offset > bytes_.size() || count > bytes_.size() - offset) {
    fail(fmt::format("{} lies outside the file", what),
         fmt::format("at least {} bytes", offset + count), fmt::format("{}", bytes_.size()),
         "The file seems to be cut off or damaged.");
  }
  return bytes_.substr(offset, count);
}

std::uint8_t C3dBytes::byte(std::size_t offset, std::string_view what) const {
  return *data(slice(offset, 1, what));
}

std::uint16_t C3dBytes::word(std::size_t offset, std::string_view what) const {
  const unsigned char* bytes = data(slice(offset, 2, what));
  return processor_ == C3dProcessor::mips ? decode_word<C3dProcessor::mips>(bytes)
                                          : decode_word<C3dProcessor::intel>(bytes);
}

float C3dBytes::real(std::size_t offset, std::string_view what) const {
  const unsigned char* bytes = data(slice(offset, 4, what));
  switch (processor_) {
  case C3dProcessor::dec:
    return decode_real<C3dProcessor::dec>(bytes);
  case C3dProcessor::mips:
    return decode_real<C3dProcessor::mips>(bytes);
  case C3dProcessor::intel:
    break;
  }
  return decode_real<C3dProcessor::intel>(bytes);
}

void C3dBytes::fail(std::string what, std::string expected, std::string got,
                    std::string remedy) const {
  throw InputError({.where = std::string(where_),
                    .what = std::move(what),
                    .expected = std::move(expected),
                    .got = std::move(got),
                    .remedy = std::move(remedy)});
}

} // namespace phonomime
