// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/verbs.h"

#include "tools/cli/terminal.h"

#include <fmt/format.h>

namespace phonomime {

void run_verb(const TuneArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const TuneReport report = run_tune(arguments.options, progress);
  clear_progress();
  if (report.found > 0 && !common.quiet) {
    print_message(fmt::format("{} evaluations were taken from {}", report.found,
                              arguments.options.journal.string()));
  }
  if (common.json) {
    print(tuning_json(report.tuning));
  } else if (!common.quiet) {
    print(tuning_text(report.tuning));
  }
}

} // namespace phonomime
