// SPDX-License-Identifier: GPL-3.0-or-later
// One reader under libFuzzer: whatever the bytes are, it gives a result or throws InputError.
#include "db/import/readers.h"
#include "db/types/errors.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    phonomime::PHONOMIME_FUZZ_READER({reinterpret_cast<const char*>(data), size}, "input");
  } catch (const phonomime::InputError&) {
    return 0;
  }
  return 0;
}
