// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/verbs.h"

#include "db/types/errors.h"
#include "tools/cli/line_reader.h"
#include "tools/cli/terminal.h"

#include <algorithm>

#include <fmt/format.h>

namespace phonomime {

namespace {

// What a stream cost more than `least`, also as a share of that.
std::string above(double cost, double least) {
  const double loss = std::max(0.0, cost - least);
  return least > 0.0 ? fmt::format("{:.1f} ({:.1f} %)", loss, 100.0 * loss / least)
                     : fmt::format("{:.1f}", loss);
}

std::string summary(const StreamReport& report) {
  std::string text = fmt::format("{} sounding phonemes, {:.2f} s, {} frames: cost {:.1f}",
                                 report.phonemes, report.duration_s, report.frames, report.cost);
  if (report.lower_bound) {
    text +=
        fmt::format(", above the optimum by at most {}", above(report.cost, *report.lower_bound));
  }
  if (report.optimum) {
    text += fmt::format("; the optimum costs {:.1f}: above it by {}", *report.optimum,
                        above(report.cost, *report.optimum));
  }
  return text;
}

} // namespace

void run_verb(const StreamArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  if (common.json) {
    throw UsageError(
        {.where = "--json", .what = "does not go with --stream: frames go to standard output"});
  }
  StreamOptions options = arguments.options;
  options.bound_loss = !common.quiet;
  LineReader lines(progress);
  const StreamReport report = run_stream(options,
                                         {.next_line = [&] { return lines.next(); },
                                          .write = print,
                                          .warn =
                                              [&](const std::string& warning) {
                                                if (!common.quiet) {
                                                  print_message("warning: " + warning);
                                                }
                                              }},
                                         progress);
  clear_progress();
  if (!common.quiet) {
    print_message(summary(report));
  }
}

} // namespace phonomime
