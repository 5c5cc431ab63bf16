// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/verbs.h"

#include "tools/cli/terminal.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

// What is said of a node before its marks.
nlohmann::ordered_json suspect_to_json(const RankedSuspect& suspect, double rate_hz) {
  const NodeRecord& node = suspect.node;
  nlohmann::ordered_json marks = nlohmann::ordered_json::array();
  for (const SuspectMark& mark : node.suspect) {
    marks.push_back({{"reason", mark.reason},
                     {"score", mark.score},
                     {"origin", mark.origin == SuspectOrigin::recording ? "recording" : "channels"},
                     {"first_frame", mark.first_frame},
                     {"frames", mark.frame_count},
                     {"start", mark.first_frame / rate_hz},
                     {"end", (mark.first_frame + mark.frame_count) / rate_hz},
                     {"groups", mark.groups},
                     {"text", mark.text}});
  }
  return {{"key", node.key},         {"score", suspect.score},  {"phoneme", node.phoneme},
          {"emotion", node.emotion}, {"speaker", node.speaker}, {"sentence", node.sentence},
          {"start", node.start_s},   {"end", node.end_s},       {"frames", node.frame_count},
          {"has_gap", node.has_gap}, {"pruned", node.pruned},   {"marks", std::move(marks)}};
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string quoted_text = "\"";
  for (const char c : text) {
    quoted_text += c == '"' ? "\"\"" : std::string(1, c);
  }
  return quoted_text + '"';
}

std::string to_csv(const SuspectsReport& report) {
  std::string text = "key,score,phoneme,emotion,start,end,reason,mark_score,first_frame,frames,"
                     "groups,text\n";
  for (const auto& [node, score] : report.suspects) {
    for (const SuspectMark& mark : node.suspect) {
      text += fmt::format(
          "{},{:.3g},{},{},{:.3f},{:.3f},{},{:.3g},{},{},{},{}\n", csv_field(node.key), score,
          csv_field(node.phoneme), csv_field(node.emotion), node.start_s, node.end_s, mark.reason,
          mark.score, mark.first_frame, mark.frame_count,
          csv_field(fmt::format("{}", fmt::join(mark.groups, " "))), csv_field(mark.text));
    }
  }
  return text;
}

std::string to_text(const SuspectsReport& report) {
  std::string text = "key\tscore\twhy\n";
  for (const auto& [node, score] : report.suspects) {
    std::vector<std::string> texts;
    for (const SuspectMark& mark : node.suspect) {
      texts.push_back(mark.text);
    }
    text += fmt::format("{}\t{:.3g}\t{}{}\n", node.key, score, node.pruned ? "pruned; " : "",
                        fmt::join(texts, "; "));
  }
  return text;
}

} // namespace

void run_verb(const SuspectsArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const SuspectsReport report = list_suspects(arguments.options, progress);
  clear_progress();
  if (common.json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const RankedSuspect& suspect : report.suspects) {
      json.push_back(suspect_to_json(suspect, report.rate_hz));
    }
    print(json.dump(1) + "\n");
    return;
  }
  if (arguments.form == SuspectsForm::keys) {
    std::string keys;
    for (const RankedSuspect& suspect : report.suspects) {
      keys += suspect.node.key + "\n";
    }
    print(keys);
    return;
  }
  print(arguments.form == SuspectsForm::csv ? to_csv(report) : to_text(report));
  if (!common.quiet && arguments.form == SuspectsForm::text) {
    const std::size_t shown = report.suspects.size();
    print_message(shown == report.found ? fmt::format("{} suspects", shown)
                                        : fmt::format("{} of {} suspects", shown, report.found));
  }
}

} // namespace phonomime
