// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/timestamp.h"

#include "db/types/text.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

namespace phonomime::store {

std::string timestamp() {
  using namespace std::chrono;
  sys_seconds now = floor<seconds>(system_clock::now());
  if (const char* fixed = std::getenv("SOURCE_DATE_EPOCH")) {
    if (const auto since_1970_s = parse_integer(fixed)) {
      now = sys_seconds(seconds(*since_1970_s));
    }
  }
  const sys_days day = floor<days>(now);
  const year_month_day date(day);
  const hh_mm_ss time(now - day);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     time.hours().count(), time.minutes().count(), time.seconds().count());
}

} // namespace phonomime::store
