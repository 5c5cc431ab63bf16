// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/verbs.h"

#include "tools/cli/print_report.h"
#include "tools/cli/terminal.h"

#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

constexpr std::array<std::string_view, 3> kActions = {"prune", "restore", "undo"};
constexpr std::array<std::string_view, 3> kDone = {"pruned", "restored", "changed back"};
constexpr std::size_t kShownParts = 20;

std::string_view name_of(CurationAction action) {
  return kActions[static_cast<std::size_t>(action)];
}

nlohmann::ordered_json entry_to_json(const JournalEntry& entry) {
  nlohmann::ordered_json json = {{"entry", entry.id},      {"action", name_of(entry.action)},
                                 {"by", entry.by},         {"at", entry.at},
                                 {"reason", entry.reason}, {"undoes", nullptr},
                                 {"undone", entry.undone}, {"nodes", entry.keys}};
  if (entry.undoes) {
    json["undoes"] = *entry.undoes;
  }
  return json;
}

nlohmann::ordered_json report_to_json(const CurateOptions& options, const CurateReport& report) {
  nlohmann::ordered_json thin = nlohmann::ordered_json::array();
  for (const ThinPart& part : report.thin) {
    thin.push_back({{"kind", part.kind},
                    {"speaker", part.speaker},
                    {"name", part.name},
                    {"before", part.before},
                    {"after", part.after}});
  }
  const CurationOutcome& outcome = report.outcome;
  return {
      {"action", name_of(options.action)},
      {"dry_run", options.dry_run},
      {"entry", outcome.entry ? entry_to_json(*outcome.entry) : nlohmann::ordered_json(nullptr)},
      {"unchanged", outcome.unchanged},
      {"in_use", {{"before", outcome.before.nodes}, {"after", outcome.after.nodes}}},
      {"thin_below", options.thin_below},
      {"thin", std::move(thin)}};
}

std::string nodes(std::size_t count) {
  return fmt::format("{} {}", count, count == 1 ? "node" : "nodes");
}

std::string report_to_text(const CurateOptions& options, const CurateReport& report) {
  const CurationOutcome& outcome = report.outcome;
  std::string text;
  if (outcome.entry) {
    const JournalEntry& entry = *outcome.entry;
    text += fmt::format("{}{} {}", options.dry_run ? "would have " : "",
                        kDone[static_cast<std::size_t>(options.action)], nodes(entry.keys.size()));
    text +=
        options.dry_run ? "\n" : fmt::format(" (journal entry {}, by {})\n", entry.id, entry.by);
    if (entry.undoes) {
      text += fmt::format("takes back  entry {}\n", *entry.undoes);
    }
  } else {
    text += "nothing to do\n";
  }
  if (!outcome.unchanged.empty()) {
    text += fmt::format("left alone  {} that {} {} already\n", nodes(outcome.unchanged.size()),
                        outcome.unchanged.size() == 1 ? "was" : "were",
                        options.action == CurationAction::prune ? "pruned" : "in use");
  }
  text +=
      fmt::format("in use      {} nodes, before {}\n", outcome.after.nodes, outcome.before.nodes);
  std::size_t shown = 0;
  for (const ThinPart& part : report.thin) {
    if (++shown > kShownParts) {
      break;
    }
    text += fmt::format("thin        {} {} of {}: {} nodes, before {}\n", part.kind, part.name,
                        part.speaker, part.after, part.before);
  }
  if (report.thin.size() > kShownParts) {
    text += fmt::format("thin        {} more (see --json)\n", report.thin.size() - kShownParts);
  }
  return text;
}

} // namespace

void run_verb(const CurateArguments& arguments, const CommonArguments& common, const Progress&) {
  const CurateReport report = run_curation(arguments.options);
  print_report(common, report_to_json(arguments.options, report),
               report_to_text(arguments.options, report));
}

void run_verb(const JournalArguments& arguments, const CommonArguments& common, const Progress&) {
  const std::vector<JournalEntry> entries =
      MotionDatabase::open(arguments.database, OpenMode::read_only).journal();
  if (common.json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const JournalEntry& entry : entries) {
      json.push_back(entry_to_json(entry));
    }
    print(json.dump(1) + "\n");
    return;
  }
  std::string text = "entry\tat\tby\taction\tnodes\treason\n";
  for (const JournalEntry& entry : entries) {
    const std::string undoes = entry.undoes   ? fmt::format(" of {}", *entry.undoes)
                               : entry.undone ? " (undone)"
                                              : "";
    text += fmt::format("{}\t{}\t{}\t{}{}\t{}\t{}\n", entry.id, entry.at, entry.by,
                        name_of(entry.action), undoes, entry.keys.size(), entry.reason);
  }
  print(text);
}

} // namespace phonomime
