// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"

#include <optional>
#include <string>

namespace phonomime {

// Standard input line by line, each as soon as it is there. While it waits it hears a request to
// stop, and notices when nobody reads standard output any more.
class LineReader {
public:
  explicit LineReader(const Progress& progress) : progress_(progress) {}

  // The next line without its end; nothing at the end of the input. Throws Interrupted, IoError
  // where the input cannot be read or the output's reader is gone, InputError for a line of more
  // than 64 kB.
  std::optional<std::string> next();

private:
  void wait() const;

  const Progress& progress_;
  std::string buffer_;
  bool ended_ = false;
  long line_ = 0;
};

} // namespace phonomime
