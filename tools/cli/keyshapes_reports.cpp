// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/retarget_reports.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

nlohmann::ordered_json paths_json(const std::vector<std::filesystem::path>& paths) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const std::filesystem::path& path : paths) {
    json.push_back(path.string());
  }
  return json;
}

nlohmann::ordered_json curves_json(const std::vector<ErrorCurve>& curves) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const ErrorCurve& curve : curves) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const KeyshapeError& error : curve.errors) {
      points.push_back({{"count", error.count}, {"mean_square", error.mean_square}});
    }
    json.push_back({{"method", curve.name}, {"errors", std::move(points)}});
  }
  return json;
}

nlohmann::ordered_json set_json(const KeyshapeSet& set) {
  nlohmann::ordered_json keyshapes = nlohmann::ordered_json::array();
  for (const ChosenKeyshape& keyshape : set.keyshapes) {
    nlohmann::ordered_json one = {{"name", keyshape.name},
                                  {"node", keyshape.node},
                                  {"relative_time", keyshape.relative_time}};
    if (keyshape.axis >= 0) {
      one["axis"] = keyshape.axis;
      one["largest"] = keyshape.largest;
    }
    keyshapes.push_back(std::move(one));
  }
  return {{"expression", set.expression},      {"part", set.part},
          {"keyshapes", std::move(keyshapes)}, {"frames", set.frames},
          {"measured", set.measured},          {"left_out", set.left_out},
          {"mean_square", set.mean_square},    {"motion_square", set.motion_square},
          {"curves", curves_json(set.curves)}};
}

} // namespace

nlohmann::ordered_json keyshapes_json(const ChooseKeyshapesReport& report) {
  nlohmann::ordered_json sets = nlohmann::ordered_json::array();
  for (const KeyshapeSet& set : report.choice.sets) {
    sets.push_back(set_json(set));
  }
  return {{"sets", std::move(sets)},
          {"fitted", report.fitted},
          {"written", paths_json(report.written)}};
}

std::string keyshapes_text(const ChooseKeyshapesReport& report,
                           const std::filesystem::path& folder) {
  std::string text;
  for (const KeyshapeSet& set : report.choice.sets) {
    text += fmt::format("{}, {}: {} chosen from {} frames", set.expression, set.part,
                        set.keyshapes.size(), set.frames);
    if (set.left_out > 0) {
      text += fmt::format(", {} extrema like others left out", set.left_out);
    }
    text +=
        fmt::format("; mean squared error {:.4g} of {:.4g}\n", set.mean_square, set.motion_square);
    for (const ChosenKeyshape& keyshape : set.keyshapes) {
      text +=
          fmt::format("  {}  {} at {:.2f}", keyshape.name, keyshape.node, keyshape.relative_time);
      text += keyshape.axis < 0
                  ? "\n"
                  : fmt::format(", {} of axis {}\n", keyshape.largest ? "largest" : "smallest",
                                keyshape.axis + 1);
    }
  }
  return text + fmt::format("{} files in {}; rig.json {}\n", report.written.size(), folder.string(),
                            report.fitted ? "has weights as fitted" : "is to be filled in");
}

nlohmann::ordered_json rig_json(const ApplyRigReport& report) {
  nlohmann::ordered_json json = {{"target", report.target},
                                 {"frames", report.frames},
                                 {"rate_hz", report.rate_hz},
                                 {"keyshapes", report.keyshapes},
                                 {"used", report.used},
                                 {"notes", report.notes},
                                 {"conflicts", nlohmann::ordered_json::array()}};
  for (const RigConflict& conflict : report.conflicts) {
    json["conflicts"].push_back({{"expression", conflict.expression},
                                 {"part", conflict.part},
                                 {"from", conflict.from},
                                 {"to", conflict.to},
                                 {"other_from", conflict.other_from},
                                 {"other_to", conflict.other_to},
                                 {"source_likeness", conflict.source_likeness},
                                 {"target_likeness", conflict.target_likeness},
                                 {"value", conflict.value}});
  }
  json["written"] = paths_json(report.written);
  return json;
}

std::string rig_text(const ApplyRigReport& report) {
  std::string text = fmt::format("{} frames at {:.6g} Hz: {} of {} keyshapes used\n", report.frames,
                                 report.rate_hz, report.used, report.keyshapes);
  for (const std::string& note : report.notes) {
    text += note + "\n";
  }
  for (const RigConflict& conflict : report.conflicts) {
    text += conflict_words(conflict) + "\n";
  }
  for (const std::filesystem::path& path : report.written) {
    text += fmt::format("wrote {}\n", path.string());
  }
  return text;
}

} // namespace phonomime
