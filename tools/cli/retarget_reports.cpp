// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/retarget_reports.h"

#include "db/types/live_link_columns.h"
#include "tools/evaluate/text_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

std::string or_dash(const std::string& name) {
  return name.empty() ? "-" : name;
}

std::string markers_text(const FaceOffer& offer) {
  if (!offer.placed) {
    return "markers: nothing says where they sit (a table markers.tsv beside the face would)\n";
  }
  std::string text =
      fmt::format("markers: {} placed{}\n", *offer.placed,
                  offer.marker_table.empty() ? " by their numbers" : " by " + offer.marker_table);
  if (!offer.missing.empty()) {
    text += fmt::format("  not on the face: {}\n", fmt::join(offer.missing, " "));
  }
  if (!offer.unknown.empty()) {
    text += fmt::format("  not in the database: {}\n", fmt::join(offer.unknown, " "));
  }
  return text;
}

} // namespace

nlohmann::ordered_json face_offer_json(const FaceOffer& offer) {
  nlohmann::ordered_json json = {{"face", offer.file.string()},
                                 {"arkit_shapes", offer.arkit_shapes},
                                 {"shapes", nlohmann::ordered_json::array()},
                                 {"meshes", nlohmann::ordered_json::array()},
                                 {"nodes", nlohmann::ordered_json::array()}};
  for (const FaceOffer::Shape& shape : offer.shapes) {
    json["shapes"].push_back({{"name", shape.name},
                              {"arkit", shape.arkit.empty() ? nlohmann::ordered_json(nullptr)
                                                            : nlohmann::ordered_json(shape.arkit)},
                              {"extent_mm", shape.extent_mm}});
  }
  for (const SceneMesh& mesh : offer.meshes) {
    json["meshes"].push_back({{"name", mesh.name},
                              {"vertices", mesh.vertices},
                              {"triangles", mesh.triangles},
                              {"shapes", mesh.shapes.size()}});
  }
  for (const SceneNode& node : offer.nodes) {
    json["nodes"].push_back({{"name", node.name},
                             {"parent", node.parent < 0 ? nlohmann::ordered_json(nullptr)
                                                        : nlohmann::ordered_json(node.parent)},
                             {"mesh", node.mesh < 0 ? nlohmann::ordered_json(nullptr)
                                                    : nlohmann::ordered_json(node.mesh)}});
  }
  json["markers"] = {{"table", offer.marker_table.empty()
                                   ? nlohmann::ordered_json(nullptr)
                                   : nlohmann::ordered_json(offer.marker_table)},
                     {"placed", offer.placed ? nlohmann::ordered_json(*offer.placed)
                                             : nlohmann::ordered_json(nullptr)},
                     {"missing", offer.missing},
                     {"unknown", offer.unknown}};
  return json;
}

std::string face_offer_text(const FaceOffer& offer) {
  std::string text = fmt::format("{}\n", offer.file.string());
  if (offer.shapes.empty()) {
    text += "no shapes of its own\n";
  } else {
    TextTable table({"shape", "mm", "ARKit"});
    for (const FaceOffer::Shape& shape : offer.shapes) {
      table.add({shape.name, fmt::format("{:.2f}", shape.extent_mm), or_dash(shape.arkit)});
    }
    text += table.text() + fmt::format("{} shapes, {} of ARKit's {}\n", offer.shapes.size(),
                                       offer.arkit_shapes, kArkitShapeCount);
  }
  for (const SceneMesh& mesh : offer.meshes) {
    text += fmt::format("mesh {}: {} vertices, {} triangles, {} shapes\n", or_dash(mesh.name),
                        mesh.vertices, mesh.triangles, mesh.shapes.size());
  }
  for (const SceneNode& node : offer.nodes) {
    text += fmt::format("node {}{}\n", or_dash(node.name),
                        node.parent < 0
                            ? ""
                            : " under " +
                                  or_dash(offer.nodes[static_cast<std::size_t>(node.parent)].name));
  }
  return text + markers_text(offer);
}

nlohmann::ordered_json retarget_json(const RetargetReport& report) {
  nlohmann::ordered_json json = {{"method", retarget_method_name(report.method)},
                                 {"frames", report.frames},
                                 {"rate_hz", report.rate_hz},
                                 {"shapes", report.shapes},
                                 {"moved", report.moved},
                                 {"left_out", report.left_out},
                                 {"notes", report.notes},
                                 {"written", nlohmann::ordered_json::array()}};
  if (!report.figures_json.empty()) {
    json["figures"] = nlohmann::ordered_json::parse(report.figures_json);
  }
  for (const std::filesystem::path& path : report.written) {
    json["written"].push_back(path.string());
  }
  return json;
}

std::string retarget_text(const RetargetReport& report) {
  std::string text =
      fmt::format("{} frames at {:.6g} Hz by {}: {} of {} shapes move\n", report.frames,
                  report.rate_hz, retarget_method_name(report.method), report.moved, report.shapes);
  for (const std::string& note : report.notes) {
    text += note + "\n";
  }
  if (!report.left_out.empty()) {
    text += fmt::format("not on the face: {}\n", fmt::join(report.left_out, " "));
  }
  for (const std::filesystem::path& path : report.written) {
    text += fmt::format("wrote {}\n", path.string());
  }
  return text;
}

nlohmann::ordered_json references_json(const ReferencesReport& report) {
  const ReferenceCoverage& coverage = report.coverage;
  return {{"frames", report.frames},
          {"extremes", report.extremes},
          {"shapes", report.shapes},
          {"fitted", report.fitted},
          {"coverage",
           {{"explained", coverage.explained},
            {"median", coverage.median},
            {"percentile_95", coverage.percentile_95},
            {"farthest", coverage.farthest},
            {"farthest_node", report.farthest},
            {"classes", coverage.classes},
            {"classes_met", coverage.classes_met}}}};
}

std::string references_text(const ReferencesReport& report) {
  const ReferenceCoverage& coverage = report.coverage;
  return fmt::format("{} frames, {} of them extremes; {} shapes, {}\n"
                     "{} of {} pairs of viseme and emotion have a frame\n"
                     "{:.0f} % of the motion's variance is covered; the farthest frame is in {}\n",
                     report.frames, report.extremes, report.shapes,
                     report.fitted ? "weights as fitted" : "weights to be filled in",
                     coverage.classes_met, coverage.classes, 100.0 * coverage.explained,
                     report.farthest);
}

} // namespace phonomime
