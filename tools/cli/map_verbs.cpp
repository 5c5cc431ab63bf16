// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/map_reports.h"
#include "tools/cli/print_report.h"
#include "tools/cli/terminal.h"
#include "tools/cli/verbs.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

// Of maps that were made for this call alone; JSON says so itself.
void tell_state(MapState state, const std::string& phoneme, const std::filesystem::path& database,
                const CommonArguments& common) {
  if (state != MapState::fresh && !common.quiet && !common.json) {
    print_message(fmt::format("the stored maps of /{}/ are {}: made anew, not stored (`phonomime "
                              "map build {}` stores them)",
                              phoneme, map_state_name(state), database.string()));
  }
}

} // namespace

void run_verb(const MapBuildArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const std::vector<BuiltMap> maps = build_phoneme_maps(arguments.options, progress);
  print_report(common, built_maps_json(maps), built_maps_text(maps));
}

void run_verb(const MapShowArguments& arguments, const CommonArguments& common, const Progress&) {
  const std::vector<ShownMap> maps =
      show_phoneme_maps(arguments.database, arguments.speaker, arguments.phoneme);
  print_answer(common, shown_maps_json(maps), shown_maps_text(maps));
}

void run_verb(const MapImageArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const MapImageReport report = draw_map_image(arguments.options, progress);
  clear_progress();
  tell_state(report.state, report.record.phoneme, arguments.options.database, common);
  print_report(common, map_image_json(arguments.options, report),
               map_image_text(arguments.options, report));
}

void run_verb(const MapPickArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const MapPickReport report = pick_on_map(arguments.options, progress);
  clear_progress();
  tell_state(report.state, report.record.phoneme, arguments.options.database, common);
  print_answer(common, map_pick_json(arguments.options, report),
               map_pick_text(arguments.options, report));
}

void run_verb(const MapQualityArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const std::vector<MapFigures> figures = measure_phoneme_maps(arguments.options, progress);
  clear_progress();
  for (const MapFigures& figure : figures) {
    tell_state(figure.state, figure.record.phoneme, arguments.options.database, common);
  }
  print_answer(common, map_figures_json(figures),
               arguments.csv ? map_figures_csv(figures) : map_figures_text(figures));
}

} // namespace phonomime
