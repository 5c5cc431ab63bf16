// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/readers.h"
#include "db/types/file_io.h"
#include "db/types/layout.h"
#include "db/types/live_link_columns.h"
#include "synth/retarget/face_scene.h"
#include "synth/retarget/mapping/cross_mapping.h"
#include "synth/retarget/mapping/marker_shapes.h"
#include "synth/retarget/mapping/reference_frames.h"
#include "synth/retarget/marker_map.h"
#include "synth/retarget/mesh_reader.h"
#include "synth/retarget/shape_names.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace phonomime::test {

// The head of ../shared/data/faces/ict with the markers of grid_s1.
struct IctFace {
  Layout layout;
  ShapeFace face;
  std::vector<int> vertices; // of the markers
  MarkerShapes shapes;       // placed on `reference`
  Eigen::MatrixXd skin_gram; // #shapes by #shapes: w' G w = mean squared movement of the skin, mm^2

  // Root mean square over the skin's vertices and all frames, mm.
  double vertex_rms(const FrameMatrixD& weight_differences) const {
    const FrameMatrixD moved = weight_differences * skin_gram;
    return std::sqrt(moved.cwiseProduct(weight_differences).sum() /
                     static_cast<double>(weight_differences.rows()));
  }
};

// `reference`: the markers at rest, #channels; empty: where the canonical face has them, in mm.
inline IctFace read_ict_face(const std::filesystem::path& data, Eigen::VectorXd reference = {}) {
  IctFace ict;
  ict.layout = parse_layout(read_file(data / "grid_s1/layout.json"), "layout.json");
  ict.face = read_shape_face(data / "faces/ict");
  const auto table = data / "faces/ict/markers.tsv";
  ict.vertices = parse_marker_map(read_file(table), table.string(), ict.layout,
                                  ict.face.neutral.skin_vertex_count())
                     .vertices;
  if (reference.size() == 0) {
    const TriangleMesh canonical = read_mesh(data / "faces/canonical/canonical_face_model.obj");
    reference.resize(ict.layout.channel_count());
    for (int g = 0; g < ict.layout.group_count(); ++g) {
      const auto vertex = std::stoi(ict.layout.groups[static_cast<std::size_t>(g)].name.substr(2));
      reference.segment<3>(3 * g) = 10.0 * canonical.positions.row(vertex).transpose();
    }
  }
  ict.shapes = shapes_at_markers(ict.face, ict.vertices, reference);
  const Eigen::Index skin = ict.face.neutral.skin_vertex_count();
  Eigen::MatrixXd moves(3 * skin, ict.shapes.shape_count());
  for (std::size_t s = 0; s < ict.face.offsets.size(); ++s) {
    const Points part = ict.face.offsets[s].topRows(skin) * ict.shapes.placement.scale;
    moves.col(static_cast<Eigen::Index>(s)) =
        Eigen::Map<const Eigen::VectorXd>(part.data(), part.size());
  }
  ict.skin_gram = moves.transpose() * moves / static_cast<double>(skin);
  return ict;
}

// A Live Link Face take as weights of the face's shapes, both halves of a shape that ARKit has
// whole alike: #frames by #shapes.
inline FrameMatrixD read_take(const std::filesystem::path& path, const IctFace& ict) {
  const MotionClip clip = read_motion(path);
  FrameMatrixD weights = FrameMatrixD::Zero(clip.frame_count(), ict.shapes.shape_count());
  for (std::size_t s = 0; s < ict.shapes.names.size(); ++s) {
    const auto shape = arkit_shape(ict.shapes.names[s]);
    if (!shape) {
      continue;
    }
    const auto found = std::ranges::find(clip.groups, kLiveLinkColumns[*shape]);
    if (found != clip.groups.end()) {
      weights.col(static_cast<Eigen::Index>(s)) =
          clip.frames.col(found - clip.groups.begin()).cast<double>();
    }
  }
  return weights.array().isNaN().select(0.0, weights).cwiseMax(0.0).cwiseMin(1.0);
}

// Markers of the face at some weights: #frames by #channels.
inline FrameMatrixD performed(const MarkerShapes& shapes, const FrameMatrixD& weights) {
  return (weights * shapes.offsets.transpose()).rowwise() + shapes.rest.transpose();
}

// Normal noise (Box and Muller) of a deviation, the same on every machine.
inline FrameMatrixD with_noise(FrameMatrixD channels, double deviation, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return (static_cast<double>(random()) + 0.5) / 4294967296.0; };
  for (double& value : channels.reshaped()) {
    value += deviation * std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * M_PI * uniform());
  }
  return channels;
}

// A share of the markers of each frame missing.
inline FrameMatrixD with_gaps(FrameMatrixD channels, double share, unsigned seed) {
  std::mt19937 random(seed);
  for (Eigen::Index k = 0; k < channels.rows(); ++k) {
    for (Eigen::Index g = 0; g < channels.cols() / 3; ++g) {
      if (static_cast<double>(random()) < share * 4294967296.0) {
        channels.row(k).segment(3 * g, 3).setConstant(std::numeric_limits<double>::quiet_NaN());
      }
    }
  }
  return channels;
}

// A smooth map of space that takes `from` to `to` exactly (thin plates in three dimensions: |x| and
// an affine part); both #points by 3.
class Warp {
public:
  Warp(const Points& from, const Points& to) : from_(from) {
    const Eigen::Index n = from.rows();
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 4, n + 4);
    for (Eigen::Index i = 0; i < n; ++i) {
      system.block(i, 0, 1, n) = (from.rowwise() - from.row(i)).rowwise().norm().transpose();
      system.block(i, n, 1, 4) << 1.0, from.row(i);
    }
    system.bottomLeftCorner(4, n) = system.topRightCorner(n, 4).transpose();
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n + 4, 3);
    right.topRows(n) = to;
    coefficients_ = system.fullPivLu().solve(right);
  }
  FrameMatrixD apply(const FrameMatrixD& channels) const {
    FrameMatrixD result(channels.rows(), channels.cols());
    const Eigen::Index n = from_.rows();
    Eigen::RowVectorXd basis(n + 4);
    for (Eigen::Index k = 0; k < channels.rows(); ++k) {
      for (Eigen::Index g = 0; g < channels.cols() / 3; ++g) {
        const Eigen::RowVector3d at = channels.row(k).segment<3>(3 * g);
        basis.head(n) = (from_.rowwise() - at).rowwise().norm().transpose();
        basis.tail(4) << 1.0, at;
        result.row(k).segment<3>(3 * g) = basis * coefficients_;
      }
    }
    return result;
  }

private:
  Points from_;
  Eigen::MatrixXd coefficients_;
};

inline PcaModel pca_of(const FrameMatrixD& channels, Eigen::Index dimensions) {
  PcaModel pca;
  pca.mean = channels.colwise().mean().transpose();
  const Eigen::MatrixXd centred = channels.rowwise() - pca.mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(centred.transpose() * centred /
                                                             static_cast<double>(channels.rows()));
  pca.basis = eigen.eigenvectors().rightCols(dimensions).rowwise().reverse();
  pca.variance = eigen.eigenvalues().tail(dimensions).reverse();
  return pca;
}

// A cross-mapping from `count` frames whose weights are known, spread as wide as they can be.
inline CrossMapping cross_mapping_of(const MarkerShapes& shapes, const FrameMatrixD& channels,
                                     const FrameMatrixD& weights, int count,
                                     const CrossMappingOptions& options) {
  const PcaModel pca = pca_of(channels, 25);
  const FrameMatrixD points = (channels.rowwise() - pca.mean.transpose()) * pca.basis.leftCols(8);
  std::vector<Eigen::Index> all(static_cast<std::size_t>(channels.rows()));
  std::iota(all.begin(), all.end(), 0);
  const std::vector<Eigen::Index> chosen = farthest_points(points, {}, all, count);
  return {pca,
          {.shapes = shapes.names,
           .channels = channels(chosen, Eigen::all),
           .weights = weights(chosen, Eigen::all)},
          options};
}

} // namespace phonomime::test
