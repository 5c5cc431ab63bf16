// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace phonomime {

// SHA-256 of bytes that come piece by piece. Throws InternalError where the library fails.
class Sha256 {
public:
  Sha256();
  ~Sha256();

  void add(std::string_view bytes);

  // Of all that was added, as 64 hexadecimal digits. Nothing can be added afterwards.
  std::string hex();

private:
  struct Context;
  std::unique_ptr<Context> context_;
};

// As `sha256sum` prints it.
std::string sha256(std::string_view bytes);

} // namespace phonomime
