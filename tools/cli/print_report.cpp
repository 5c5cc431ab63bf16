// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/print_report.h"

#include "tools/cli/terminal.h"

#include <nlohmann/json.hpp>

namespace phonomime {

void print_answer(const CommonArguments& common, const nlohmann::ordered_json& json,
                  std::string_view text) {
  if (common.json) {
    print(json.dump(1) + "\n");
  } else {
    print(text);
  }
}

void print_report(const CommonArguments& common, const nlohmann::ordered_json& json,
                  std::string_view text) {
  clear_progress();
  if (common.json || !common.quiet) {
    print_answer(common, json, text);
  }
}

} // namespace phonomime
