// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/choose_keyshapes.h"

#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "synth/retarget/keyshapes/region_basis.h"
#include "tools/app/keyshape_folder.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr Eigen::Index kMostMeasured = 2000; // frames, for errors
constexpr int kCurveSteps = 10;

// Frames to choose from.
struct FramePool {
  FrameMatrixD coefficients;
  std::vector<NodeIndex> node;      // of each frame
  std::vector<std::int32_t> inside; // its place in the node
};

// Those of the nodes of an emotion, or of all.
FramePool frame_pool(const MotionTable& table, const std::string* emotion) {
  FramePool pool;
  std::vector<Eigen::Index> rows;
  for (NodeIndex n = 0; n < table.node_count(); ++n) {
    const MotionNode& node = table.nodes[static_cast<std::size_t>(n)];
    if (emotion != nullptr && table.emotions[static_cast<std::size_t>(node.emotion)] != *emotion) {
      continue;
    }
    for (std::int32_t k = 0; k < node.frame_count; ++k) {
      pool.node.push_back(n);
      pool.inside.push_back(k);
      rows.push_back(node.first_frame + k);
    }
  }
  pool.coefficients = table.coefficients(rows, Eigen::all).cast<double>();
  return pool;
}

KeyshapeSet choose_set(const MotionTable& table, const FramePool& pool, const std::string& part,
                       const KeyshapeOptions& options, std::vector<Eigen::Index>& rows) {
  const std::vector<int> channels = part_channels(table.layout, part);
  const FrameMatrixD points = part_coefficients(table.pca, pool.coefficients, channels);
  const KeyshapeSelection selection = select_keyshapes(points, options);
  const Eigen::Index frames = pool.coefficients.rows();
  const KeyshapeMeasure measure{
      .offsets =
          part_offset_coordinates(table.pca, pool.coefficients, channels, table.reference_pose),
      .groups = static_cast<int>(channels.size()) / table.layout.channels_per_group(),
      .every = static_cast<int>((frames + kMostMeasured - 1) / kMostMeasured)};
  rows.clear();
  KeyshapeSet set{.expression = {},
                  .part = part,
                  .keyshapes = {},
                  .frames = static_cast<long>(frames),
                  .measured = static_cast<long>(measure.measured().rows()),
                  .left_out = selection.left_out.size()};
  for (const Keyshape& keyshape : selection.chosen) {
    rows.push_back(keyshape.frame);
    const NodeIndex node = pool.node[static_cast<std::size_t>(keyshape.frame)];
    const std::int32_t count = table.nodes[static_cast<std::size_t>(node)].frame_count;
    const std::int32_t inside = pool.inside[static_cast<std::size_t>(keyshape.frame)];
    set.keyshapes.push_back(
        {.name = {},
         .node = table.key(node),
         .relative_time = count > 1 ? static_cast<double>(inside) / (count - 1) : 0.5,
         .axis = keyshape.axis,
         .largest = keyshape.largest});
  }
  set.mean_square = reconstruction_error(measure, rows);
  set.motion_square = motion_square(measure);
  set.curves = error_curves(points, measure, options, kCurveSteps);
  return set;
}

} // namespace

KeyshapeChoice choose_keyshapes(const MotionTable& table, const ChooseKeyshapesOptions& options,
                                const Progress& progress) {
  options.keyshapes.validate();
  for (const std::string& part : options.parts) {
    part_channels(table.layout, part);
    if (std::ranges::count(options.parts, part) > 1) {
      throw UsageError({.where = "--parts", .what = "a part is named twice", .got = part});
    }
  }
  const std::vector<std::string> expressions =
      options.by_emotion ? table.emotions : std::vector<std::string>{std::string("neutral")};
  KeyshapeChoice choice;
  choice.coefficients.resize(0, table.coefficients.cols());
  for (const std::string& expression : expressions) {
    const FramePool pool = frame_pool(table, options.by_emotion ? &expression : nullptr);
    if (pool.node.empty()) {
      continue;
    }
    for (const std::string& part : options.parts) {
      progress.update("choosing keyshapes", std::ssize(choice.sets),
                      std::ssize(expressions) * std::ssize(options.parts));
      std::vector<Eigen::Index> rows;
      KeyshapeSet set = choose_set(table, pool, part, options.keyshapes, rows);
      set.expression = expression;
      const Eigen::Index before = choice.coefficients.rows();
      for (std::size_t i = 0; i < rows.size(); ++i) {
        set.keyshapes[i].name = fmt::format("k{:02}", before + static_cast<Eigen::Index>(i));
      }
      choice.coefficients.conservativeResize(before + std::ssize(rows), Eigen::NoChange);
      choice.coefficients.bottomRows(std::ssize(rows)) = pool.coefficients(rows, Eigen::all);
      choice.sets.push_back(std::move(set));
    }
  }
  if (choice.sets.empty()) {
    throw InputError({.where = options.database.string(),
                      .what = "there are no motion nodes to choose keyshapes from"});
  }
  return choice;
}

ChooseKeyshapesReport write_keyshapes(const ChooseKeyshapesOptions& options,
                                      const Progress& progress) {
  options.keyshapes.validate();
  const RigTarget target = rig_target_named(options.target);
  const MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_only);
  const MotionTable table = database.load_motion_table(options.speaker);
  ChooseKeyshapesReport report{.choice = choose_keyshapes(table, options, progress)};
  KeyshapeFolder folder = keyshape_folder(report.choice, table, target, options.face, progress);
  report.fitted = folder.fitted;
  std::error_code failed;
  std::filesystem::create_directories(options.output, failed);
  if (failed) {
    throw IoError({.where = options.output.string(),
                   .what = "the folder cannot be made",
                   .got = failed.message()});
  }
  OutputFiles outputs;
  for (const auto& [name, bytes] : folder.files) {
    outputs.stage(options.output / name, bytes);
    report.written.push_back(options.output / name);
  }
  outputs.commit();
  return report;
}

} // namespace phonomime
