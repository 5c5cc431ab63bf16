// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/print_report.h"
#include "tools/cli/terminal.h"
#include "tools/cli/verbs.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

constexpr std::size_t kNotAlignedShown = 10;
constexpr std::size_t kIterationsShown = 8;

nlohmann::ordered_json report_json(const StyleReport& report) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(report.trained_json);
  json["speaker"] = report.speaker;
  json["state"] = style_state_name(report.state);
  json["error"] = {{"unit", report.unit}, {"reconstruction", report.reconstruction}};
  if (report.translation) {
    json["error"]["translation"] = *report.translation;
    json["error"]["mean_difference"] = report.mean_difference.value_or(0.0);
    json["error"]["unchanged"] = report.unchanged.value_or(0.0);
  }
  return json;
}

// The first iterations and the last, joined by arrows.
std::string curve(const std::vector<double>& errors) {
  std::string text;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (i + 1 < errors.size() && i >= kIterationsShown) {
      text += i == kIterationsShown ? " -> ..." : "";
      continue;
    }
    text += fmt::format("{}{:.4f}", i > 0 ? " -> " : "", errors[i]);
  }
  return text;
}

std::string report_text(const StyleReport& report) {
  const TrainedStyle& trained = report.trained;
  const StyleModel& model = trained.model;
  std::string text =
      fmt::format("speaker     {}: {} sentences in {}; {} nodes aligned, {} left out, {} frames\n",
                  report.speaker, trained.sentences.size(), fmt::join(model.known.styles, ", "),
                  trained.nodes, trained.nodes_left_out, trained.columns);
  text += fmt::format("state       {}\n", style_state_name(report.state));
  text += fmt::format("known       J = {} of {}, ridge {:.4g}, bundles of {}; reconstruction error "
                      "{:.3f} {}\n",
                      model.known.content_size(), model.known.spectrum.size(), model.ridge,
                      model.bundle, report.reconstruction, report.unit);
  if (report.translation) {
    text += fmt::format("held out    {:.3f} {} from each emotion to each other; by adding the mean "
                        "difference {:.3f}, unchanged {:.3f}\n",
                        *report.translation, report.unit, report.mean_difference.value_or(0.0),
                        report.unchanged.value_or(0.0));
  }
  text += fmt::format("unknown     I = {}, J = {}; {} after {} iterations, error {}\n",
                      model.unknown.style_size(), model.unknown.content_size(),
                      model.unknown.converged ? "converged" : "not converged",
                      model.unknown.convergence.size(), curve(model.unknown.convergence));
  if (trained.chosen_unknown) {
    const UnknownChoice& best = trained.chosen_unknown->best;
    text += fmt::format("found       {} of {} emotions of frames that were left out\n", best.found,
                        best.windows);
  }
  for (const ValidRange& range : model.valid) {
    text += fmt::format("valid       {} up to {:.2f}\n", range.emotion, range.largest_intensity);
  }
  for (const auto& [phoneme, range] : model.contacts) {
    text += fmt::format("contact     /{}/ {:.1f} to {:.1f} mm\n", phoneme, range.least_mm,
                        range.most_mm);
  }
  const std::size_t shown = std::min(trained.not_aligned.size(), kNotAlignedShown);
  for (std::size_t i = 0; i < shown; ++i) {
    text += fmt::format("not aligned {}: {}\n", trained.not_aligned[i].sentence,
                        trained.not_aligned[i].reason);
  }
  if (shown < trained.not_aligned.size()) {
    text += fmt::format("            and {} more (--json has all)\n",
                        trained.not_aligned.size() - shown);
  }
  return text;
}

std::string apply_text(const StyleApplyReport& report) {
  std::string text = fmt::format("{} frames at {:.4g} a second, shown: {}{}\n", report.frames,
                                 report.fps, report.from, report.from_found ? " (found)" : "");
  for (const auto& [emotion, distance] : report.distances) {
    text += fmt::format("  {:<12} {:.3f} away\n", emotion, distance);
  }
  text += fmt::format("changed by {:.2f} {} (the PCA does not hold {:.2f})\n", report.change,
                      report.unit, report.residual);
  if (report.contacts > 0) {
    text += fmt::format("contacts of the lips: {}, of which {} had to be mended, {} could not be\n",
                        report.contacts, report.contacts_moved, report.contacts_left);
  }
  for (const std::string& note : report.notes) {
    text += note + "\n";
  }
  for (const std::filesystem::path& path : report.written) {
    text += fmt::format("wrote {}\n", path.string());
  }
  return text;
}

} // namespace

void run_verb(const StyleTrainArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const StyleReport report = train_style_models(arguments.options, progress);
  print_report(common, report_json(report), report_text(report));
}

void run_verb(const StyleShowArguments& arguments, const CommonArguments& common, const Progress&) {
  const StyleReport report = show_style_models(arguments.database, arguments.speaker);
  print_answer(common, report_json(report), report_text(report));
}

void run_verb(const StyleApplyArguments& arguments, const CommonArguments& common,
              const Progress&) {
  const StyleApplyReport report = apply_style_to_file(arguments.options);
  if (!common.quiet) {
    for (const std::string& warning : report.warnings) {
      print_message("warning: " + warning);
    }
  }
  if (common.json) {
    print(style_apply_json(report));
  } else if (!common.quiet) {
    print(apply_text(report));
  }
}

} // namespace phonomime
