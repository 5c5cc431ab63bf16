// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/retarget_references.h"

#include "db/store/motion_database.h"
#include "db/types/file_io.h"
#include "synth/retarget/face_scene.h"
#include "synth/retarget/mapping/pair_table.h"
#include "tools/app/fitted_frames.h"

#include <fmt/format.h>

namespace phonomime {

namespace {

// What the frame stands for, for the person who gives it weights.
std::string note_of(const ProposedFrame& reference, const MotionTable& table) {
  const MotionNode& node = table.nodes[static_cast<std::size_t>(reference.node)];
  const std::string& emotion = table.emotions[static_cast<std::size_t>(node.emotion)];
  return reference.extreme
             ? "extreme " + emotion
             : fmt::format("{} {}", table.visemes[static_cast<std::size_t>(node.viseme)], emotion);
}

PairTable pairs_of(const std::vector<ProposedFrame>& references, const MotionTable& table) {
  PairTable pairs;
  for (const ProposedFrame& reference : references) {
    pairs.rows.push_back(
        {.frame = {.node = table.key(reference.node), .time_s = reference.frame / table.rate_hz},
         .note = note_of(reference, table),
         .line = 0});
  }
  return pairs;
}

FrameMatrixD channels_of(const std::vector<ProposedFrame>& references, const MotionTable& table) {
  FrameMatrixD channels(static_cast<Eigen::Index>(references.size()), table.pca.channel_count());
  for (std::size_t i = 0; i < references.size(); ++i) {
    const MotionNode& node = table.nodes[static_cast<std::size_t>(references[i].node)];
    const auto frame = table.coefficients.row(node.first_frame + references[i].frame);
    channels.row(static_cast<Eigen::Index>(i)) =
        table.pca.reconstruct(frame.transpose().cast<double>()).transpose();
  }
  return channels;
}

} // namespace

ReferencesReport propose_pairs(const RetargetReferencesOptions& options) {
  options.references.validate();
  const MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_only);
  const MotionTable table = database.load_motion_table(options.speaker);
  const ShapeFace face = read_shape_face(options.face);
  const std::vector<ProposedFrame> references = propose_references(table, options.references);
  PairTable pairs = pairs_of(references, table);
  pairs.shapes = face.names;
  const bool markers = table.layout.kind == LayoutKind::markers;
  pairs.weights = markers ? fitted_frames(face, options.face, table, channels_of(references, table))
                          : FrameMatrixD::Zero(static_cast<Eigen::Index>(references.size()),
                                               static_cast<Eigen::Index>(face.names.size()));
  ReferencesReport report;
  report.frames = references.size();
  for (const ProposedFrame& reference : references) {
    report.extremes += reference.extreme ? 1 : 0;
  }
  report.shapes = face.names.size();
  report.fitted = markers;
  report.coverage = coverage_of(table, references, options.references.dimensions);
  if (report.coverage.farthest_node != kNoNode) {
    report.farthest = table.key(report.coverage.farthest_node);
  }
  write_file(options.output, format_pair_table(pairs));
  return report;
}

} // namespace phonomime
