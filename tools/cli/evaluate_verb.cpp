// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/verbs.h"

#include "tools/cli/terminal.h"
#include "tools/evaluate/report.h"

#include <nlohmann/json.hpp>

namespace phonomime {

void run_verb(const EvaluateArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const EvaluateReport report = run_evaluate(arguments.options, progress);
  clear_progress();
  if (common.json) {
    print(evaluation_json(report.evaluation, report.comparison).dump(1) + "\n");
  } else if (!common.quiet) {
    print(evaluation_text(report.evaluation, report.comparison));
  }
}

} // namespace phonomime
