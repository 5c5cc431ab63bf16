// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace phonomime {

// Byte order and number format of a C3D file, as its parameter section numbers them.
enum class C3dProcessor : std::uint8_t { intel = 84, dec = 85, mips = 86 };

// The four bytes of a VAX F_floating number as DEC machines store it; a reserved operand is NaN.
float decode_dec_float(const unsigned char* bytes);

// The bytes of a C3D file. Every access is checked: outside the file it throws InputError that
// names the file and what was wanted there.
class C3dBytes {
public:
  static constexpr std::size_t kBlock = 512;

  C3dBytes(std::string_view bytes, std::string_view where) : bytes_(bytes), where_(where) {}

  std::size_t size() const { return bytes_.size(); }
  std::string_view where() const { return where_; }
  C3dProcessor processor() const { return processor_; }
  void set_processor(C3dProcessor processor) { processor_ = processor; }

  // `count` bytes at `offset`; `what` says in errors what they hold.
  std::string_view slice(std::size_t offset, std::size_t count, std::string_view what) const;
  std::uint8_t byte(std::size_t offset, std::string_view what) const;
  std::uint16_t word(std::size_t offset, std::string_view what) const;
  float real(std::size_t offset, std::string_view what) const;

  [[noreturn]] void fail(std::string what, std::string expected = {}, std::string got = {},
                         std::string remedy = {}) const;

private:
  std::string_view bytes_;
  std::string_view where_;
  C3dProcessor processor_ = C3dProcessor::intel;
};

// Decoders for a processor that is known when the loop over the points is compiled.
template <C3dProcessor processor>
std::uint16_t decode_word(const unsigned char* bytes) {
  return processor == C3dProcessor::mips ? static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1])
                                         : static_cast<std::uint16_t>(bytes[1] << 8 | bytes[0]);
}

template <C3dProcessor processor>
float decode_real(const unsigned char* bytes) {
  if constexpr (processor == C3dProcessor::dec) {
    return decode_dec_float(bytes);
  }
  const std::uint32_t low = decode_word<processor>(bytes);
  const std::uint32_t high = decode_word<processor>(bytes + 2);
  return std::bit_cast<float>(processor == C3dProcessor::mips ? low << 16 | high
                                                              : high << 16 | low);
}

} // namespace phonomime
