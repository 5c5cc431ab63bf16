// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/verbs.h"

#include "tools/cli/terminal.h"

#include <nlohmann/json.hpp>

namespace phonomime {

void run_verb(const ImportArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const ImportReport report = import_corpus(arguments.options, progress);
  clear_progress();
  if (common.json) {
    print(report_to_json(report).dump(1) + "\n");
  } else if (!common.quiet) {
    print(report_to_text(report));
  }
}

} // namespace phonomime
