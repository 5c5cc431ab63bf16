// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/keyshape_folder.h"

#include "db/types/errors.h"
#include "synth/export/glb.h"
#include "synth/export/motion_csv.h"
#include "synth/retarget/face_scene.h"
#include "synth/retarget/keyshapes/region_basis.h"
#include "tools/app/face_picture.h"
#include "tools/app/fitted_frames.h"
#include "tools/app/named_choice.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr double kLeastWeight = 0.005; // that a rig is begun with

std::string rest_file(RigTarget target, bool shown) {
  switch (target) {
  case RigTarget::shapes:
    return {};
  case RigTarget::mesh:
    return shown ? "rest.glb" : "rest.obj";
  case RigTarget::joints:
    return "rest.glb";
  case RigTarget::drawing:
    return "rest.svg";
  }
  return {};
}

std::string keyshape_file(RigTarget target, const std::string& name, bool shown) {
  return target == RigTarget::mesh      ? name + (shown ? ".glb" : ".obj")
         : target == RigTarget::drawing ? "drawn_" + name + ".svg"
                                        : std::string();
}

Rig begun_rig(const KeyshapeChoice& choice, RigTarget target, bool shown) {
  Rig rig{.target = target,
          .file = rest_file(target, shown),
          .source = "keyshapes.csv",
          .sets = {},
          .seam = std::nullopt};
  int row = 0;
  for (const KeyshapeSet& set : choice.sets) {
    RigSet poses{.expression = set.expression, .part = set.part, .keyshapes = {}};
    for (const ChosenKeyshape& keyshape : set.keyshapes) {
      RigKeyshape pose;
      pose.name = keyshape.name;
      pose.source = row++;
      pose.file = keyshape_file(target, keyshape.name, shown);
      poses.keyshapes.push_back(std::move(pose));
    }
    rig.sets.push_back(std::move(poses));
  }
  return rig;
}

// Channels of each keyshape: #keyshapes by #channels.
FrameMatrixD channels_of(const KeyshapeChoice& choice, const MotionTable& table) {
  FrameMatrixD channels(choice.coefficients.rows(), table.pca.channel_count());
  for (Eigen::Index i = 0; i < channels.rows(); ++i) {
    channels.row(i) = table.pca.reconstruct(choice.coefficients.row(i).transpose()).transpose();
  }
  return channels;
}

// What a keyshape of `part` is not asked for stays at rest.
FrameMatrixD parts_alone(const KeyshapeChoice& choice, const MotionTable& table,
                         const FrameMatrixD& channels) {
  FrameMatrixD alone = table.reference_pose.transpose().replicate(channels.rows(), 1);
  Eigen::Index row = 0;
  for (const KeyshapeSet& set : choice.sets) {
    const std::vector<int> own = part_channels(table.layout, set.part);
    for (std::size_t i = 0; i < set.keyshapes.size(); ++i, ++row) {
      for (const int channel : own) {
        alone(row, channel) = channels(row, channel);
      }
    }
  }
  return alone;
}

// The weights of a direct fit, each rounded to what a person would write.
void fill_in(Rig& rig, const ShapeFace& face, const FrameMatrixD& weights) {
  for (RigSet& set : rig.sets) {
    for (RigKeyshape& keyshape : set.keyshapes) {
      for (std::size_t s = 0; s < face.names.size(); ++s) {
        const double weight = weights(keyshape.source, static_cast<Eigen::Index>(s));
        if (weight >= kLeastWeight) {
          keyshape.weights.emplace(face.names[s], std::round(1000.0 * weight) / 1000.0);
        }
      }
    }
  }
}

std::string still_glb(const MarkerFace& face, const Points& positions, const std::string& title,
                      const MotionTable& table) {
  CoefficientMotion still{.rate_hz = 1.0};
  still.coefficients.resize(1, 0);
  return marker_face_glb(
      face.mesh(), {positions, {}}, still,
      {.title = title, .credits = {"Motion of " + table.speaker}, .synthetic = table.synthetic});
}

void show_on_face(const std::filesystem::path& path, const KeyshapeChoice& choice,
                  const MotionTable& table, const FrameMatrixD& poses, bool with_rest,
                  KeyshapeFolder& folder, const Progress& progress) {
  const MarkerFace face(read_face(path, table.layout), table.layout, table.reference_pose);
  // The recorded head may rest turned; pictures show the face from its own front.
  const Eigen::Matrix3d to_front = face.report().placement.rotation;
  const Eigen::Map<const Points> markers(table.reference_pose.data(),
                                         table.reference_pose.size() / 3, 3);
  const FacePainter painter(face.mesh(), markers * to_front);
  if (with_rest) {
    folder.files["rest.glb"] = still_glb(face, face.mesh().positions, "rest", table);
  }
  Eigen::Index row = 0;
  for (const KeyshapeSet& set : choice.sets) {
    for (const ChosenKeyshape& keyshape : set.keyshapes) {
      progress.update("showing keyshapes", row, poses.rows());
      const Points positions = face.deform(poses.row(row++).transpose());
      folder.files[keyshape.name + ".png"] = painter.png(positions * to_front);
      folder.files[keyshape.name + ".glb"] = still_glb(face, positions, keyshape.name, table);
    }
  }
}

} // namespace

RigTarget rig_target_named(std::string_view name) {
  return static_cast<RigTarget>(named_choice("--target", name, kRigTargetNames));
}

KeyshapeFolder keyshape_folder(const KeyshapeChoice& choice, const MotionTable& table,
                               RigTarget target, const std::filesystem::path& face,
                               const Progress& progress) {
  const bool markers = table.layout.kind == LayoutKind::markers;
  const bool shown = !face.empty();
  KeyshapeFolder folder;
  Rig rig = begun_rig(choice, target, shown);
  const CoefficientMotion frames{.rate_hz = 1.0, .coefficients = choice.coefficients, .head = {}};
  folder.files["keyshapes.csv"] = markers ? marker_csv(table.layout, table.pca, frames, false)
                                          : weight_csv(table.layout, table.pca, frames);
  for (const KeyshapeSet& set : choice.sets) {
    const std::string name = "errors_" + set.expression + "_" + set.part;
    folder.files[name + ".tsv"] = error_table_tsv(set.curves);
    folder.files[name + ".svg"] =
        error_plot_svg(set.curves, markers ? "mm\xC2\xB2" : "squared weight");
  }
  if (markers) {
    const FrameMatrixD poses = channels_of(choice, table);
    Eigen::Index row = 0;
    for (const KeyshapeSet& set : choice.sets) {
      const std::vector<int> own = part_channels(table.layout, set.part);
      for (const ChosenKeyshape& keyshape : set.keyshapes) {
        folder.files[keyshape.name + ".svg"] =
            marker_picture(table.reference_pose, poses.row(row++).transpose(), own);
      }
    }
    if (shown) {
      const FrameMatrixD alone = parts_alone(choice, table, poses);
      show_on_face(face, choice, table, alone, target == RigTarget::mesh, folder, progress);
      const ShapeFace shapes = read_face_scene(face).face;
      if (target == RigTarget::shapes && !shapes.names.empty()) {
        fill_in(rig, shapes, fitted_frames(shapes, face, table, alone));
        folder.fitted = true;
      }
    }
  } else if (shown) {
    throw InputError({.where = face.string(),
                      .what = "a database of blendshape weights cannot move a mesh by markers",
                      .remedy = "Leave --face out."});
  }
  folder.files["rig.json"] = format_rig(rig);
  return folder;
}

} // namespace phonomime
