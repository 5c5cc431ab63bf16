// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/map_pick.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/lip_measures.h"
#include "db/types/text.h"
#include "isomap/triangulation.h"
#include "synth/export/glb.h"
#include "synth/export/motion_csv.h"
#include "tools/app/option_checks.h"
#include "tools/app/synth_stock.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

bool is_glb(const std::filesystem::path& path) {
  const std::string suffix = to_lower(path.extension().string());
  if (suffix != ".glb" && suffix != ".csv") {
    throw UsageError({.where = path.string(),
                      .what = "the suffix names no kind of output",
                      .expected = ".glb or .csv",
                      .got = quoted(suffix)});
  }
  return suffix == ".glb";
}

void check_options(const MapPickOptions& options) {
  check_range("--threads", options.threads, 0, 256);
  constexpr double kFarthest = 1e100; // squares of which are finite
  check_range("X", options.x, -kFarthest, kFarthest);
  check_range("Y", options.y, -kFarthest, kFarthest);
  check_outputs_differ(options.outputs);
  bool needs_face = false;
  for (const std::filesystem::path& output : options.outputs) {
    needs_face = is_glb(output) || needs_face;
  }
  if (needs_face == options.face.empty()) {
    throw UsageError(
        {.what = needs_face ? "a .glb output needs a face" : "no output shows the face",
         .remedy = needs_face ? "Name a mesh with --face: an .obj or .glb file, or the "
                                "folder that holds it."
                              : "Name one with -o FILE.glb, or leave --face out."});
  }
}

std::vector<std::string> channel_names(const Layout& layout) {
  std::vector<std::string> names;
  for (const ChannelGroup& group : layout.groups) {
    if (layout.kind == LayoutKind::weights) {
      names.push_back(group.name);
      continue;
    }
    for (const char* axis : {"_x", "_y", "_z"}) {
      names.push_back(group.name + axis);
    }
  }
  return names;
}

PickedPoint describe(const MotionTable& table, const PhonemeMaps& maps, const MapPlaces& places,
                     std::int32_t row, double weight) {
  const std::int32_t frame = maps.kept[static_cast<std::size_t>(row)];
  const PhonemeCluster& cluster = maps.cluster;
  const auto n = static_cast<std::size_t>(cluster.node_of[static_cast<std::size_t>(frame)]);
  const ClusterNode& node = cluster.nodes[n];
  return {.node = table.key(node.node),
          .frame = frame - node.first,
          .relative_time = cluster.relative_time(frame),
          .emotion = table.emotions[static_cast<std::size_t>(node.emotion)],
          .x = places(row, 0),
          .y = places(row, 1),
          .weight = weight};
}

void take_frame(const MotionTable& table, const Eigen::VectorXd& coefficients,
                MapPickReport& report) {
  report.coefficients = coefficients;
  report.channel_names = channel_names(table.layout);
  report.channels = table.pca.reconstruct(coefficients);
  report.aperture_mm =
      LipMeasures(table.layout)
          .aperture_mm({report.channels.data(), static_cast<std::size_t>(report.channels.size())});
}

void write_outputs(const MapPickOptions& options, MotionTable table, MapPickReport& report) {
  if (options.outputs.empty()) {
    return;
  }
  CoefficientMotion motion{.rate_hz = table.rate_hz};
  motion.coefficients = report.coefficients.transpose();
  const std::string csv =
      motion_csv_header(table.layout) + motion_csv_rows(table.layout, table.pca, motion, false, 0);
  std::string glb;
  if (!options.face.empty()) {
    if (table.layout.kind != LayoutKind::markers) {
      throw InputError({.where = options.database.string(),
                        .what = "a database of blendshape weights cannot drive a mesh yet",
                        .remedy = "Write a .csv and apply it to the face's own shapes."});
    }
    SynthStock stock(std::move(table));
    const FittedFace& face = stock.face(options.face);
    report.face_note = face.note;
    glb = marker_face_glb(
        face.face.mesh(), face.morphs, motion,
        {.title = fmt::format("/{}/ at {:.2f} {:.2f}", options.phoneme, options.x, options.y),
         .credits = {"Motion of " + stock.table().speaker},
         .synthetic = stock.table().synthetic});
  }
  OutputFiles files;
  for (const std::filesystem::path& output : options.outputs) {
    files.stage(output, is_glb(output) ? glb : csv);
  }
  files.commit();
}

} // namespace

MapPickReport pick_on_map(const MapPickOptions& options, const Progress& progress) {
  check_options(options);
  const MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_only);
  MotionTable table = database.load_motion_table(options.speaker);
  const std::int32_t phoneme = phonemes_with_nodes(table, {options.phoneme}).front();
  const PhonemeMaps maps = fresh_maps(database, table, phoneme, options.threads, progress);
  const MapTriangulation triangulation(maps.places(options.pca));
  const PickedFrame picked = triangulation.pick(options.x, options.y);

  MapPickReport report = {.record = maps.record, .state = maps.state, .inside = picked.inside};
  const MapPlaces& places = triangulation.places();
  const std::size_t corner_count = picked.inside ? picked.corners.size() : 1;
  for (std::size_t c = 0; c < corner_count; ++c) {
    report.corners.push_back(describe(table, maps, places, picked.corners[c], picked.weights[c]));
  }
  report.nearest = describe(table, maps, places, picked.nearest, 1.0);
  report.nearest_distance = picked.nearest_distance;
  take_frame(table, interpolate_frame(picked, maps.frames()), report);
  write_outputs(options, std::move(table), report);
  return report;
}

} // namespace phonomime
