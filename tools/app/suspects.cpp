// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/suspects.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "tools/app/find_suspects.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

void check_reason(const std::string& reason) {
  if (reason.empty() || std::ranges::find(kSuspectReasons, reason) != kSuspectReasons.end()) {
    return;
  }
  const std::vector<std::string> known(kSuspectReasons.begin(), kSuspectReasons.end());
  throw UsageError({.where = "--reason",
                    .what = "there is no such reason",
                    .expected = fmt::format("one of {}", fmt::join(known, ", ")),
                    .got = quoted(reason),
                    .remedy = did_you_mean(reason, known)});
}

void judge_anew(const SuspectsOptions& options, const Progress& progress) {
  MotionDatabase::open(options.database, OpenMode::read_only); // a new file is none to judge
  MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_write);
  const DatabaseInfo info = database.info();
  database.replace_channel_suspects([&](MotionDatabase& locked) {
    return find_suspects([&](const auto& visit) { locked.for_each_stored_sentence(visit); },
                         info.layout, info.rate_hz, options.threads, progress);
  });
}

} // namespace

SuspectsReport list_suspects(const SuspectsOptions& options, const Progress& progress) {
  check_reason(options.reason);
  if (options.judge) {
    judge_anew(options, progress);
  }
  const MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_only);
  NodeFilter filter = options.filter;
  filter.suspect = true;
  if (!options.with_pruned) {
    filter.pruned = false;
  }
  SuspectsReport report;
  report.rate_hz = database.info().rate_hz;
  for (NodeRecord& node : database.list_nodes(filter)) {
    double score = 0.0;
    for (const SuspectMark& mark : node.suspect) {
      if (options.reason.empty() || mark.reason == options.reason) {
        score = std::max(score, mark.score);
      }
    }
    if (score > 0.0) {
      report.suspects.push_back({.node = std::move(node), .score = score});
    }
  }
  std::ranges::stable_sort(report.suspects, std::greater<>(), &RankedSuspect::score);
  report.found = report.suspects.size();
  if (options.limit > 0 && options.limit < report.suspects.size()) {
    report.suspects.resize(options.limit);
  }
  return report;
}

} // namespace phonomime
