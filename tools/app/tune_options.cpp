// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"
#include "db/types/text.h"
#include "tools/app/option_checks.h"
#include "tools/app/tune.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

constexpr int kMostFolds = 100;
constexpr std::array<std::string_view, 3> kReportKinds = {".html", ".json", ".txt"};
constexpr double kLongest_min = 1e6;

} // namespace

Measure tune_objective(const std::string& name) {
  const std::optional<Measure> measure =
      find_measure(name == "e13" ? info(Measure::squared_error).id : std::string_view(name));
  if (measure && badness(*measure, 0.0)) {
    return *measure;
  }
  std::vector<std::string> known = {"e13"};
  for (const Measure one : all_measures()) {
    if (badness(one, 0.0)) {
      known.emplace_back(info(one).id);
    }
  }
  throw UsageError({.where = "--objective",
                    .what = quoted(name) + " is no measure that can be made better",
                    .expected = fmt::format("one of {}", fmt::join(known, ", ")),
                    .remedy = did_you_mean(name, known)});
}

void TuneOptions::validate() const {
  constexpr double kMost = std::numeric_limits<int>::max();
  import.validate();
  check_motion_options(synth);
  check_range("--folds", folds, 2, kMostFolds);
  check_range("--inner", inner, 2, kMostFolds);
  check_range("--sentences", sentences, inner, kMost);
  check_range("--held-out", held_out, 0, kMost);
  check_range("--starts", starts, 0, 10000);
  check_range("--descents", descents, 1, 1000);
  check_range("--evaluations", evaluations, 1, 100000);
  check_range("--time-limit", time_limit_min, 0, kLongest_min);
  tune_objective(objective);
  if (to_lower(output.extension().string()) != ".json") {
    throw UsageError({.where = output.string(),
                      .what = "the weights file's suffix does not say what it is",
                      .expected = ".json"});
  }
  std::vector<std::filesystem::path> outputs = reports;
  for (const std::filesystem::path& path : reports) {
    if (std::ranges::find(kReportKinds, to_lower(path.extension().string())) ==
        kReportKinds.end()) {
      throw UsageError({.where = path.string(),
                        .what = "the report's suffix does not say what it is to be",
                        .expected = fmt::format("one of {}", fmt::join(kReportKinds, ", "))});
    }
  }
  outputs.push_back(output);
  if (!journal.empty()) {
    outputs.push_back(journal);
  }
  check_outputs_differ(outputs);
}

} // namespace phonomime
