// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/verbs.h"

#include "tools/cli/terminal.h"

#include <fmt/format.h>

namespace phonomime {

void run_verb(const SynthArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  SynthOptions options = arguments.options;
  options.tells_result = common.json;
  const SynthReport report = run_synth(options, progress);
  clear_progress();
  if (!common.quiet) {
    for (const std::string& warning : report.warnings) {
      print_message("warning: " + warning);
    }
  }
  if (common.json) {
    print(report.result_json);
    return;
  }
  if (common.quiet) {
    return;
  }
  print(fmt::format("{} sounding phonemes, {:.2f} s: cost {:.1f}, {} of {} joins between chosen "
                    "nodes as recorded\n",
                    report.phonemes, report.duration_s, report.cost, report.captured_joins,
                    report.joins));
  for (const std::string& note : report.notes) {
    print(note + "\n");
  }
  for (const std::filesystem::path& path : report.written) {
    print(fmt::format("wrote {}\n", path.string()));
  }
}

} // namespace phonomime
