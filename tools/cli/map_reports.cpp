// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/map_reports.h"

#include "db/types/text.h"
#include "tools/evaluate/text_table.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

nlohmann::ordered_json to_json(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

// How maps were made, and what was found.
nlohmann::ordered_json to_json(const StoredMapRecord& record) {
  return {{"options",
           {{"neighbours", record.neighbours},
            {"components", record.keep_largest ? "largest" : "join"},
            {"largest_exact", record.largest_exact},
            {"landmarks", record.landmark_count},
            {"seed", record.seed}}},
          {"nodes", record.nodes},
          {"frames", record.frames},
          {"placed", record.placed},
          {"components", record.components},
          {"landmarks", record.landmarks},
          {"far_frames", record.far_frames},
          {"residual_variance",
           {{"isomap", record.isomap_residual_variance}, {"pca", record.pca_residual_variance}}}};
}

std::vector<std::string> record_cells(const StoredMapRecord& record) {
  return {fmt::format("{}", record.nodes),
          fmt::format("{}", record.frames),
          fmt::format("{}", record.placed),
          fmt::format("{}", record.components),
          record.landmarks > 0 ? fmt::format("{}", record.landmarks) : "all",
          fmt::format("{}", record.far_frames),
          shown(record.isomap_residual_variance, 3),
          shown(record.pca_residual_variance, 3)};
}

std::vector<std::string> row_of(std::string name, const std::vector<std::string>& cells,
                                std::string last) {
  std::vector<std::string> row = {std::move(name)};
  row.insert(row.end(), cells.begin(), cells.end());
  row.push_back(std::move(last));
  return row;
}

TextTable record_table(std::string last) {
  return TextTable(row_of(
      "phoneme", {"nodes", "frames", "on map", "parts", "landmarks", "far", "residual", "of PCA"},
      std::move(last)));
}

const char* map_name(bool of_pca) {
  return of_pca ? "pca" : "isomap";
}

nlohmann::ordered_json to_json(const PickedPoint& point) {
  return {
      {"node", point.node},       {"frame", point.frame}, {"relative_time", point.relative_time},
      {"emotion", point.emotion}, {"x", point.x},         {"y", point.y},
      {"weight", point.weight}};
}

std::string line_of(const PickedPoint& point) {
  return fmt::format("  {:.3f}  {}  frame {} (relative time {:.2f}), {}, at {:.2f} {:.2f}\n",
                     point.weight, point.node, point.frame, point.relative_time, point.emotion,
                     point.x, point.y);
}

} // namespace

nlohmann::ordered_json built_maps_json(const std::vector<BuiltMap>& maps) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const BuiltMap& map : maps) {
    nlohmann::ordered_json entry = {{"phoneme", map.record.phoneme},
                                    {"built", map.before != MapState::fresh}};
    entry.update(to_json(map.record));
    json.push_back(std::move(entry));
  }
  return json;
}

std::string built_maps_text(const std::vector<BuiltMap>& maps) {
  TextTable table = record_table("");
  std::size_t built = 0;
  for (const BuiltMap& map : maps) {
    const bool is_new = map.before != MapState::fresh;
    built += is_new ? 1 : 0;
    table.add(row_of(map.record.phoneme, record_cells(map.record), is_new ? "built" : "was fresh"));
  }
  return table.text() + fmt::format("{} maps built, {} were fresh\n", built, maps.size() - built);
}

nlohmann::ordered_json shown_maps_json(const std::vector<ShownMap>& maps) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const ShownMap& map : maps) {
    nlohmann::ordered_json entry = {{"phoneme", map.phoneme},
                                    {"nodes", map.nodes},
                                    {"frames", map.frames},
                                    {"state", map_state_name(map.state)},
                                    {"map", nullptr}};
    if (map.state != MapState::missing) {
      entry["map"] = to_json(map.record);
    }
    json.push_back(std::move(entry));
  }
  return json;
}

std::string shown_maps_text(const std::vector<ShownMap>& maps) {
  TextTable table = record_table("state");
  for (const ShownMap& map : maps) {
    StoredMapRecord now = map.record;
    now.nodes = map.nodes;
    now.frames = map.frames;
    std::vector<std::string> cells = record_cells(now);
    if (map.state == MapState::missing) {
      std::fill(cells.begin() + 2, cells.end(), "-");
    }
    table.add(row_of(map.phoneme, cells, map_state_name(map.state)));
  }
  return table.text();
}

nlohmann::ordered_json map_image_json(const MapImageOptions& options,
                                      const MapImageReport& report) {
  nlohmann::ordered_json json = {{"phoneme", report.record.phoneme},
                                 {"map", map_name(options.pca)},
                                 {"state", map_state_name(report.state)}};
  json.update(to_json(report.record));
  json["highlighted"] = {{"context_correct", report.context_correct},
                         {"chosen", report.chosen},
                         {"suspect", report.suspect},
                         {"pruned", report.pruned}};
  json["written"] = nlohmann::ordered_json::array();
  for (const std::filesystem::path& output : options.outputs) {
    json["written"].push_back(output.string());
  }
  return json;
}

std::string map_image_text(const MapImageOptions& options, const MapImageReport& report) {
  std::string text = fmt::format("/{}/: {} frames of {} nodes, residual variance {:.3f}\n",
                                 report.record.phoneme, report.record.placed, report.record.nodes,
                                 options.pca ? report.record.pca_residual_variance
                                             : report.record.isomap_residual_variance);
  const auto add = [&](bool asked, std::int64_t count, const char* what) {
    text += asked ? fmt::format("{} {}\n", count, what) : "";
  };
  add(!options.previous.empty(), report.context_correct, "nodes of the triphone");
  add(!options.chosen.empty() || !options.path.empty(), report.chosen, "nodes chosen");
  add(options.suspects, report.suspect, "suspects");
  add(options.pruned, report.pruned, "pruned nodes");
  for (const std::filesystem::path& output : options.outputs) {
    text += fmt::format("wrote {}\n", output.string());
  }
  return text;
}

nlohmann::ordered_json map_pick_json(const MapPickOptions& options, const MapPickReport& report) {
  nlohmann::ordered_json json = {{"phoneme", report.record.phoneme},
                                 {"map", map_name(options.pca)},
                                 {"state", map_state_name(report.state)},
                                 {"x", options.x},
                                 {"y", options.y},
                                 {"inside", report.inside},
                                 {"corners", nlohmann::ordered_json::array()}};
  for (const PickedPoint& corner : report.corners) {
    json["corners"].push_back(to_json(corner));
  }
  json["nearest"] = to_json(report.nearest);
  json["nearest"].erase("weight");
  json["nearest"]["distance"] = report.nearest_distance;
  json["aperture"] = to_json(report.aperture_mm);
  json["coefficients"] =
      std::vector<double>(report.coefficients.begin(), report.coefficients.end());
  json["channels"] = nlohmann::ordered_json::object();
  for (std::size_t c = 0; c < report.channel_names.size(); ++c) {
    json["channels"][report.channel_names[c]] = report.channels[static_cast<Eigen::Index>(c)];
  }
  json["written"] = nlohmann::ordered_json::array();
  for (const std::filesystem::path& output : options.outputs) {
    json["written"].push_back(output.string());
  }
  return json;
}

std::string map_pick_text(const MapPickOptions& options, const MapPickReport& report) {
  std::string text =
      report.inside
          ? fmt::format("/{}/ at {} {}, inside the map: between three frames\n", options.phoneme,
                        format_number(options.x), format_number(options.y))
          : fmt::format("/{}/ at {} {}, OUTSIDE the map: the nearest frame, {:.2f} away\n",
                        options.phoneme, format_number(options.x), format_number(options.y),
                        report.nearest_distance);
  for (const PickedPoint& corner : report.corners) {
    text += line_of(corner);
  }
  if (report.aperture_mm) {
    text += fmt::format("lips {:.1f} mm open\n", *report.aperture_mm);
  }
  text += report.face_note.empty() ? "" : report.face_note + "\n";
  for (const std::filesystem::path& output : options.outputs) {
    text += fmt::format("wrote {}\n", output.string());
  }
  return text;
}

nlohmann::ordered_json map_figures_json(const std::vector<MapFigures>& figures) {
  nlohmann::ordered_json phonemes = nlohmann::ordered_json::array();
  for (const MapFigures& figure : figures) {
    nlohmann::ordered_json entry = {{"phoneme", figure.record.phoneme},
                                    {"nodes", figure.record.nodes},
                                    {"frames", figure.record.placed},
                                    {"emotions", figure.emotions},
                                    {"state", map_state_name(figure.state)}};
    for (const bool of_pca : {false, true}) {
      nlohmann::ordered_json& of_map = entry[map_name(of_pca)];
      for (const MapMeasure& measure : map_measures()) {
        of_map[measure.id] = to_json(measure.of(figure, of_pca));
      }
      of_map["purity_by_lot"] = to_json((of_pca ? figure.pca : figure.isomap).purity_by_lot);
    }
    phonemes.push_back(std::move(entry));
  }
  nlohmann::ordered_json contests = nlohmann::ordered_json::object();
  for (const MapMeasure& measure : map_measures()) {
    const MapContest contest = compare_maps(figures, measure);
    contests[measure.id] = {{"phonemes", contest.phonemes()},
                            {"isomap_better", contest.isomap_better},
                            {"pca_better", contest.pca_better},
                            {"isomap_mean", contest.isomap_mean},
                            {"pca_mean", contest.pca_mean}};
  }
  return {{"phonemes", std::move(phonemes)}, {"compared", std::move(contests)}};
}

std::string map_figures_csv(const std::vector<MapFigures>& figures) {
  std::string text = "phoneme,map,nodes,frames,emotions";
  for (const MapMeasure& measure : map_measures()) {
    text += fmt::format(",{}", measure.id);
  }
  text += ",purity_by_lot\n";
  const auto field = [](const std::optional<double>& value) {
    return value ? "," + format_number(*value) : std::string(",");
  };
  for (const MapFigures& figure : figures) {
    for (const bool of_pca : {false, true}) {
      text += fmt::format("{},{},{},{},{}", figure.record.phoneme, map_name(of_pca),
                          figure.record.nodes, figure.record.placed, figure.emotions);
      for (const MapMeasure& measure : map_measures()) {
        text += field(measure.of(figure, of_pca));
      }
      text += field((of_pca ? figure.pca : figure.isomap).purity_by_lot) + "\n";
    }
  }
  return text;
}

std::string map_figures_text(const std::vector<MapFigures>& figures) {
  std::vector<std::string> header = {"phoneme", "frames"};
  for (const MapMeasure& measure : map_measures()) {
    header.push_back(measure.name);
    header.emplace_back("of PCA");
  }
  header.emplace_back("by lot");
  TextTable table(header);
  for (const MapFigures& figure : figures) {
    std::vector<std::string> row = {figure.record.phoneme, fmt::format("{}", figure.record.placed)};
    for (const MapMeasure& measure : map_measures()) {
      for (const bool of_pca : {false, true}) {
        row.push_back(shown(measure.of(figure, of_pca), 3));
      }
    }
    row.push_back(shown(figure.isomap.purity_by_lot, 3));
    table.add(std::move(row));
  }
  std::string text = table.text();
  for (const MapMeasure& measure : map_measures()) {
    const MapContest contest = compare_maps(figures, measure);
    if (contest.phonemes() > 0) {
      text += fmt::format("{}: Isomap better for {} of {} phonemes, PCA for {}; by frames {:.3f} "
                          "against {:.3f} ({} is better)\n",
                          measure.name, contest.isomap_better, contest.phonemes(),
                          contest.pca_better, contest.isomap_mean, contest.pca_mean,
                          measure.more_is_better ? "more" : "less");
    }
  }
  return text;
}

} // namespace phonomime
