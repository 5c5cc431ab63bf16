// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/retarget_apply.h"

#include "db/import/gaps.h"
#include "db/import/readers.h"
#include "db/import/resample.h"
#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/live_link_columns.h"
#include "db/types/text.h"
#include "synth/retarget/face_scene.h"
#include "synth/retarget/face_source.h"
#include "synth/retarget/weight_filter.h"
#include "tools/app/motion_file.h"
#include "tools/app/option_checks.h"
#include "tools/app/retarget_outputs.h"
#include "tools/app/retarget_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::array<const char*, 4> kMethodNames = {"weights", "fit", "cross", "equations"};
constexpr std::size_t kHeadAngles = 3;
constexpr std::size_t kEyeAngles = 6;

std::optional<RetargetMethod> parse_method(const std::string& name) {
  if (name.empty()) {
    return std::nullopt;
  }
  const std::vector<std::string> names(kMethodNames.begin(), kMethodNames.end());
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) {
    throw UsageError({.where = "--method",
                      .what = "is not a method",
                      .expected = "weights, fit, cross or equations",
                      .got = quoted(name),
                      .remedy = did_you_mean(name, names)});
  }
  return static_cast<RetargetMethod>(found - names.begin());
}

// #frames by the columns of these names, where the clip has all of them.
std::optional<FrameMatrix> columns_of(const MotionClip& clip, std::size_t first,
                                      std::size_t count) {
  FrameMatrix columns(clip.frames.rows(), static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const auto found = std::ranges::find(clip.groups, kLiveLinkColumns[first + i]);
    if (found == clip.groups.end()) {
      return std::nullopt;
    }
    columns.col(static_cast<Eigen::Index>(i)) = clip.frames.col(found - clip.groups.begin());
  }
  return columns;
}

// Weights without the angles of head and eyes.
MotionClip without_angles(const MotionClip& clip) {
  MotionClip weights = clip;
  weights.groups.clear();
  Eigen::Index kept = 0;
  for (std::size_t g = 0; g < clip.groups.size(); ++g) {
    if (std::find(kLiveLinkColumns.begin() + kArkitShapeCount, kLiveLinkColumns.end(),
                  clip.groups[g]) == kLiveLinkColumns.end()) {
      weights.groups.push_back(clip.groups[g]);
      weights.frames.col(kept++) = clip.frames.col(static_cast<Eigen::Index>(g));
    }
  }
  weights.frames.conservativeResize(Eigen::NoChange, kept);
  return weights;
}

// Finite everywhere, at the rate that is asked for.
MotionClip prepared(MotionClip clip, double rate_hz, const std::string& where,
                    std::vector<std::string>& notes) {
  if (clip.frames.rows() == 0) {
    throw InputError({.where = where, .what = "the motion has no frame"});
  }
  const std::vector<int> absent =
      groups_missing_throughout(clip.frames.cast<double>(), clip.channels_per_group);
  if (!absent.empty()) {
    throw InputError({.where = where,
                      .what = "no frame has a value of " +
                              quoted(clip.groups[static_cast<std::size_t>(absent.front())])});
  }
  const GapFill filled =
      fill_gaps(clip.frames.cast<double>(), clip.channels_per_group, clip.rate_hz, 0.1);
  const auto held = std::ranges::count(filled.frame_has_gap, 1);
  if (held > 0) {
    notes.push_back(fmt::format("{} frames without values are bridged", held));
  }
  if (rate_hz == 0.0 || rate_hz == clip.rate_hz) {
    clip.frames = filled.frames.cast<float>();
    return clip;
  }
  const double duration_s = static_cast<double>(clip.frames.rows() - 1) / clip.rate_hz;
  const auto count = static_cast<Eigen::Index>(std::floor(duration_s * rate_hz + 1e-6)) + 1;
  clip.frames = resample(filled.frames, {.rate_hz = clip.rate_hz, .start_s = 0.0}, rate_hz, count)
                    .cast<float>();
  clip.rate_hz = rate_hz;
  return clip;
}

// Live Link Face's signs: yaw to its own left, pitch up, roll to its own left are positive.
std::vector<HeadPose> live_link_head(const FrameMatrix& angles) {
  std::vector<HeadPose> head;
  if (angles.isZero(0.0F)) {
    return head;
  }
  for (Eigen::Index frame = 0; frame < angles.rows(); ++frame) {
    head.push_back(
        {.translation_mm = Eigen::Vector3d::Zero(),
         .rotation = head_rotation(
             {.yaw = angles(frame, 0), .pitch = -angles(frame, 1), .roll = -angles(frame, 2)})});
  }
  return head;
}

ShapeMotion motion_of_weights(const RetargetApplyOptions& options, const MotionClip& clip,
                              const ShapeFace& face, RetargetReport& report) {
  const std::string where = options.motion.string();
  const MotionClip whole = prepared(clip, options.fps, where, report.notes);
  WeightsForFace fitting =
      weights_for_face(without_angles(whole), face.names, options.skip_missing, where);
  report.left_out = std::move(fitting.left_out);
  ShapeMotion motion{.weights = std::move(fitting.weights),
                     .head = {},
                     .placement = free_placement(face),
                     .eyes = {}};
  if (const auto angles = columns_of(whole, kArkitShapeCount, kHeadAngles)) {
    motion.head = live_link_head(*angles);
  }
  if (auto angles = columns_of(whole, kArkitShapeCount + kHeadAngles, kEyeAngles)) {
    motion.eyes = std::move(*angles);
  }
  return motion;
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

// Where the markers sit, and the similarity that brings the face to the speaker's reference pose.
Similarity place_face(const RetargetApplyOptions& options, const MotionTable& table,
                      const ShapeFace& face, MarkerMap& markers) {
  markers = read_markers(options.face, table.layout, face.neutral.skin_vertex_count());
  return place_on_markers(
      face.neutral, markers.vertices,
      Eigen::Map<const Points>(table.reference_pose.data(), table.reference_pose.size() / 3, 3));
}

ShapeMotion motion_of_markers(const RetargetApplyOptions& options, RetargetMethod method,
                              double recorded_hz, const ShapeFace& face, RetargetReport& report,
                              const Progress& progress) {
  const MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_only);
  const MotionTable table = database.load_motion_table(options.speaker);
  const MotionFile file = read_motion_file(options.motion, table, {.layout = options.layout},
                                           options.fps == 0.0 ? recorded_hz : options.fps);
  report.notes.insert(report.notes.end(), file.notes.begin(), file.notes.end());
  MarkerMap markers;
  const bool on_markers =
      table.layout.kind == LayoutKind::markers && method != RetargetMethod::cross;
  const Similarity placement =
      on_markers ? place_face(options, table, face, markers) : free_placement(face);
  const RetargetSource source{
      .options = options, .table = table, .motion = file, .face = face, .markers = markers};
  RetargetedWeights result = method == RetargetMethod::fit ? retarget_by_fit(source, progress)
                             : method == RetargetMethod::cross
                                 ? retarget_by_cross_mapping(source, progress)
                                 : retarget_by_equations(source, progress);
  report.notes.insert(report.notes.end(), result.notes.begin(), result.notes.end());
  report.figures_json = std::move(result.figures_json);
  ShapeMotion motion;
  motion.weights = {.rate_hz = file.rate_hz,
                    .groups = face.names,
                    .channels_per_group = 1,
                    .frames = result.weights.cast<float>()};
  motion.head = about_its_mean(file.head);
  motion.placement = placement;
  return motion;
}

void check_options(const RetargetApplyOptions& options) {
  if (options.fps != 0.0) {
    check_range("--fps", options.fps, 1.0, 1000.0);
  }
  check_range("--filter", options.filter_s, 0.0, 1.0);
  check_range("--threads", options.threads, 0, 256);
  check_outputs_differ(options.outputs);
  check_retarget_outputs(options);
}

} // namespace

const char* retarget_method_name(RetargetMethod method) {
  return kMethodNames.at(static_cast<std::size_t>(method));
}

RetargetReport apply_to_face(const RetargetApplyOptions& options, const Progress& progress) {
  check_options(options);
  const std::optional<RetargetMethod> asked = parse_method(options.method);
  const ShapeFace face = read_shape_face(options.face);
  const MotionClip clip = read_motion(options.motion);
  const bool is_weights = clip.channels_per_group == 1;
  RetargetReport report;
  report.method = asked.value_or(is_weights ? RetargetMethod::weights : RetargetMethod::fit);
  if (report.method == RetargetMethod::weights && !is_weights) {
    throw UsageError({.where = "--method",
                      .what = "weights are asked for, but the motion is of markers",
                      .expected = "fit, cross or equations"});
  }
  if (report.method != RetargetMethod::cross && !options.pairs.empty()) {
    throw UsageError({.where = "--pairs", .what = "is for --method cross"});
  }
  if (report.method != RetargetMethod::weights && options.database.empty()) {
    throw UsageError({.where = options.motion.string(),
                      .what = "motion of markers needs the database that it is from",
                      .remedy = "Name it with --db."});
  }
  ShapeMotion motion =
      report.method == RetargetMethod::weights
          ? motion_of_weights(options, clip, face, report)
          : motion_of_markers(options, report.method, clip.rate_hz, face, report, progress);
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
