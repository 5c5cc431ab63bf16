// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/verbs.h"

#include "db/types/errors.h"
#include "tools/app/batch_report.h"
#include "tools/cli/terminal.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

void print_messages(const BatchArguments& arguments, const CommonArguments& common,
                    const BatchReport& report) {
  const std::string manifest = arguments.options.manifest.string();
  for (const BatchRow& row : report.rows) {
    const std::string where = fmt::format("{} ({})", at_line(manifest, row.line), row.id);
    for (const std::string& warning : row.warnings) {
      if (!common.quiet) {
        print_message(fmt::format("warning: {}: {}", where, warning));
      }
    }
    if (row.status == RowStatus::failed) {
      print_message(fmt::format("failed: {}: {}", where, row.error));
    }
  }
}

} // namespace

void run_verb(const BatchArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const BatchReport report = run_batch(arguments.options, progress);
  clear_progress();
  if (common.json) {
    print(batch_to_json(arguments.options, report).dump(1) + "\n");
  } else {
    print_messages(arguments, common, report);
    if (!common.quiet) {
      print(batch_to_text(report));
    }
  }
  if (report.count(RowStatus::stopped) > 0) {
    throw Interrupted();
  }
  if (const std::size_t failed = report.count(RowStatus::failed); failed > 0) {
    throw Error(report.worst_error(),
                {.where = arguments.options.manifest.string(),
                 .what = fmt::format("{} of {} rows failed", failed, report.rows.size())});
  }
}

} // namespace phonomime
