// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/retarget_apply.h"

#include "db/import/readers.h"
#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "synth/retarget/face_scene.h"
#include "synth/retarget/face_source.h"
#include "synth/retarget/weight_filter.h"
#include "tools/app/motion_file.h"
#include "tools/app/named_choice.h"
#include "tools/app/named_weights.h"
#include "tools/app/option_checks.h"
#include "tools/app/retarget_outputs.h"
#include "tools/app/retarget_source.h"

#include <array>
#include <string_view>
#include <utility>

namespace phonomime {

namespace {

constexpr std::array<std::string_view, 5> kMethodNames = {"weights", "fit", "cross", "equations",
                                                          "keyshapes"};

// The one that is named, else the one that suits the motion.
RetargetMethod method_of(const std::string& name, const MotionClip& clip) {
  const bool is_weights = clip.channels_per_group == 1;
  if (name.empty()) {
    return is_weights ? RetargetMethod::weights : RetargetMethod::fit;
  }
  const auto method = static_cast<RetargetMethod>(named_choice("--method", name, kMethodNames));
  if (method == RetargetMethod::weights && !is_weights) {
    throw UsageError({.where = "--method",
                      .what = "weights are asked for, but the motion is of markers",
                      .expected = "fit, cross, equations or keyshapes"});
  }
  return method;
}

// Options of one method are not for another.
void check_method_options(const RetargetApplyOptions& options, RetargetMethod method) {
  const auto refuse = [](bool said, const char* option, const char* methods) {
    if (said) {
      throw UsageError({.where = option, .what = std::string("is for --method ") + methods});
    }
  };
  const bool keyshapes = method == RetargetMethod::keyshapes;
  const bool cross = method == RetargetMethod::cross;
  const bool solves = method == RetargetMethod::fit || keyshapes;
  refuse(!cross && !options.pairs.empty(), "--pairs", "cross");
  refuse(!cross && options.dimensions.has_value(), "--dimensions", "cross");
  refuse(!keyshapes && !options.rig.rig.empty(), "--rig", "keyshapes");
  refuse(!keyshapes && !options.rig.emotion.empty(), "--emotion", "keyshapes");
  refuse(!keyshapes && !options.rig.emotions.empty(), "--emotions", "keyshapes");
  refuse(!solves && options.weights.ridge.has_value(), "--ridge", "fit or keyshapes");
  refuse(!solves && options.weights.sparsity.has_value(), "--sparsity", "fit or keyshapes");
  refuse(!solves && options.weights.smoothness.has_value(), "--smoothness", "fit or keyshapes");
  if (method != RetargetMethod::weights && options.database.empty()) {
    throw UsageError({.where = options.motion.string(),
                      .what = "motion of markers needs the database that it is from",
                      .remedy = "Name it with --db."});
  }
}

// The head about where it is on average, so that the face stays where its file has it.
std::vector<HeadPose> about_its_mean(std::vector<HeadPose> head) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const HeadPose& pose : head) {
    mean += pose.translation_mm / static_cast<double>(head.size());
  }
  for (HeadPose& pose : head) {
    pose.translation_mm -= mean;
  }
  return head;
}

// For the methods that look at vertices under markers.
std::optional<MarkerShapes> place_shapes(const RetargetApplyOptions& options, RetargetMethod method,
                                         const ShapeFace& face, const MotionTable& table) {
  if (method != RetargetMethod::fit && method != RetargetMethod::equations) {
    return std::nullopt;
  }
  if (table.layout.kind != LayoutKind::markers) {
    throw InputError(
        {.where = options.database.string(),
         .what = "shapes are fitted to markers, but the database is of weights",
         .remedy = "Use --method cross, or give the weights themselves without --db."});
  }
  const MarkerMap markers =
      read_markers(options.face, table.layout, face.neutral.skin_vertex_count());
  return shapes_at_markers(face, markers.vertices, table.reference_pose);
}

RetargetedWeights weights_by(RetargetMethod method, const RetargetSource& source,
                             const Progress& progress) {
  switch (method) {
  case RetargetMethod::fit:
    return retarget_by_fit(source, progress);
  case RetargetMethod::equations:
    return retarget_by_equations(source, progress);
  case RetargetMethod::cross:
    return retarget_by_cross_mapping(source, progress);
  case RetargetMethod::keyshapes:
    return retarget_by_keyshapes(source, progress);
  case RetargetMethod::weights:
    break;
  }
  throw InternalError({.what = "weights by their names have no source"});
}

ShapeMotion motion_by_database(const RetargetApplyOptions& options, RetargetMethod method,
                               const MotionClip& clip, const ShapeFace& face,
                               RetargetReport& report, const Progress& progress) {
  const MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_only);
  const MotionTable table = database.load_motion_table(options.speaker);
  const MotionFile file = motion_in_layout(clip, options.motion, table, {.layout = options.layout},
                                           options.fps == 0.0 ? clip.rate_hz : options.fps);
  const std::optional<MarkerShapes> shapes = place_shapes(options, method, face, table);
  RetargetedWeights result = weights_by(
      method, {.options = options, .table = table, .motion = file, .face = face, .shapes = shapes},
      progress);
  report.notes.insert(report.notes.end(), file.notes.begin(), file.notes.end());
  report.notes.insert(report.notes.end(), result.notes.begin(), result.notes.end());
  report.figures_json = std::move(result.figures_json);
  return {.weights = {.rate_hz = file.rate_hz,
                      .groups = face.names,
                      .channels_per_group = 1,
                      .frames = result.weights.cast<float>()},
          .head = about_its_mean(file.head),
          .placement = shapes ? shapes->placement : free_placement(face),
          .eyes = {}};
}

void check_options(const RetargetApplyOptions& options) {
  if (options.fps != 0.0) {
    check_range("--fps", options.fps, 1.0, 1000.0);
  }
  check_range("--filter", options.filter_s, 0.0, 1.0);
  check_range("--dimensions", options.dimensions.value_or(0), 0, 1000);
  options.weights.over({});
  check_outputs_differ(options.outputs);
  check_retarget_outputs(options);
}

} // namespace

const char* retarget_method_name(RetargetMethod method) {
  return kMethodNames.at(static_cast<std::size_t>(method)).data();
}

RetargetReport apply_to_face(const RetargetApplyOptions& options, const Progress& progress) {
  check_options(options);
  const ShapeFace face = read_shape_face(options.face);
  const MotionClip clip = read_motion(options.motion);
  RetargetReport report;
  report.method = method_of(options.method, clip);
  check_method_options(options, report.method);
  ShapeMotion motion =
      report.method == RetargetMethod::weights
          ? motion_of_weights(options, clip, face, report)
          : motion_by_database(options, report.method, clip, face, report, progress);
  motion.weights.frames =
      filter_weights(motion.weights.frames.cast<double>(), motion.weights.rate_hz, options.filter_s)
          .cast<float>();
  if (!options.head) {
    motion.head.clear();
  }
  report.frames = static_cast<long>(motion.weights.frames.rows());
  report.rate_hz = motion.weights.rate_hz;
  report.shapes = face.names.size();
  for (Eigen::Index s = 0; s < motion.weights.frames.cols(); ++s) {
    const auto column = motion.weights.frames.col(s);
    report.moved += column.maxCoeff() > column.minCoeff() ? 1 : 0;
  }
  report.written = write_retargeted(options, face, motion);
  return report;
}

} // namespace phonomime
