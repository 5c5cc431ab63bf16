// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/print_report.h"
#include "tools/cli/terminal.h"
#include "tools/cli/verbs.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

// A line of a constraint file without its comment.
std::string line_of(const RecommendReport& report, const Recommendation& one) {
  return fmt::format("{} use {}", report.row, one.node);
}

nlohmann::ordered_json to_json(const RecommendReport& report) {
  nlohmann::ordered_json json = {{"row", report.row},
                                 {"phoneme", report.phoneme},
                                 {"previous", report.previous},
                                 {"next", report.next},
                                 {"start", report.start_s},
                                 {"end", report.end_s},
                                 {"emotion", report.emotion},
                                 {"relative_time", report.relative_time},
                                 {"cost", report.cost},
                                 {"context_correct", report.context_correct},
                                 {"recommended", nlohmann::ordered_json::array()},
                                 {"notes", report.notes},
                                 {"warnings", report.warnings}};
  for (const Recommendation& one : report.recommended) {
    nlohmann::ordered_json entry = {{"node", one.node},
                                    {"line", line_of(report, one)},
                                    {"context_correct", one.context_correct},
                                    {"chosen", one.chosen},
                                    {"delta", one.delta},
                                    {"phoneme", one.phoneme},
                                    {"previous", one.previous},
                                    {"next", one.next},
                                    {"emotion", one.emotion},
                                    {"frames", one.frames},
                                    {"frame", one.frame},
                                    {"aperture", nullptr},
                                    {"place", nullptr}};
    if (one.aperture_mm) {
      entry["aperture"] = *one.aperture_mm;
    }
    if (one.place) {
      entry["place"] = *one.place;
    }
    json["recommended"].push_back(std::move(entry));
  }
  return json;
}

// Every line is one of a constraint file.
std::string to_text(const RecommendReport& report) {
  std::string text =
      fmt::format("# row {}: {}-{}-{} from {:.3f} to {:.3f} s in {}; the best path costs {:.1f}\n",
                  report.row, report.previous, report.phoneme, report.next, report.start_s,
                  report.end_s, report.emotion, report.cost);
  text += fmt::format("# {} nodes of this triphone; frames are those at relative time {:.2f}\n",
                      report.context_correct, report.relative_time);
  std::size_t width = 0;
  for (const Recommendation& one : report.recommended) {
    width = std::max(width, line_of(report, one).size());
  }
  for (const Recommendation& one : report.recommended) {
    text += fmt::format("{:<{}}  # +{:.1f}, {}-{}-{}{}, {}, frame {:.1f} of {}",
                        line_of(report, one), width, one.delta, one.previous, one.phoneme, one.next,
                        one.context_correct ? " (same triphone)" : "", one.emotion, one.frame,
                        one.frames);
    text += one.aperture_mm ? fmt::format(", lips {:.1f} mm open", *one.aperture_mm) : "";
    text += one.place
                ? fmt::format(", on the map at {:.1f} {:.1f}", (*one.place)[0], (*one.place)[1])
                : "";
    text += one.chosen ? ", in the best path\n" : "\n";
  }
  return text;
}

} // namespace

void run_verb(const RecommendArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const RecommendReport report = recommend_nodes(arguments.options, progress);
  clear_progress();
  if (!common.quiet) {
    if (!common.json) {
      for (const std::string& note : report.notes) {
        print_message(note);
      }
    }
    for (const std::string& warning : report.warnings) {
      print_message("warning: " + warning);
    }
  }
  print_answer(common, to_json(report), to_text(report));
}

} // namespace phonomime
