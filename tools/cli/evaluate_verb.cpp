// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/verbs.h"

#include "tools/cli/print_report.h"
#include "tools/evaluate/report.h"

#include <nlohmann/json.hpp>

namespace phonomime {

void run_verb(const EvaluateArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const EvaluateReport report = run_evaluate(arguments.options, progress);
  print_report(common, evaluation_json(report.evaluation, report.comparison),
               evaluation_text(report.evaluation, report.comparison));
}

} // namespace phonomime
