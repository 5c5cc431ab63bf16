// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "synth/retarget/mapping/rbf_network.h"

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace phonomime {

// Frames of motion and the weights that a person (or a fit) gives a face for them: X's reference
// mocap-weight pairs.
struct ReferencePairs {
  std::vector<std::string> shapes;
  FrameMatrixD channels; // #pairs by #channels, as the PCA has them (mm, head motion off)
  FrameMatrixD weights;  // #pairs by #shapes, 0 to 1
};

inline constexpr int kDefaultCrossDimensions = 4; // X section 5

struct CrossMappingOptions {
  int dimensions = kDefaultCrossDimensions; // of the PCA; 0 = by cross-validation
  double sigma = 0.0;                       // of the basis functions, in the PCA's unit; 0 = by GCV

  // Throws UsageError.
  void validate() const;
};

// What another number of dimensions would do.
struct DimensionTrial {
  int dimensions = 0;
  double weight_rms = 0.0; // of each pair's weights from a network of the others, after clamping
};

// Cross-mapping (X algorithm 1): PCA coefficients of a frame (X3) to blendshape weights by one RBF
// network (X4-X6), clamped to [0, 1]. Immutable.
class CrossMapping {
public:
  // Throws InputError where the pairs are fewer than 3 or all alike, InternalError where sizes do
  // not agree. More dimensions than the PCA has, or as many as there are pairs, are cut back.
  CrossMapping(const PcaModel& pca, const ReferencePairs& pairs,
               const CrossMappingOptions& options = {});

  const std::vector<std::string>& shapes() const { return shapes_; }
  int dimensions() const { return static_cast<int>(pca_.dimension_count()); }
  const RbfNetwork& network() const { return network_; }
  double weight_rms_left_out() const { return weight_rms_; }            // as DimensionTrial's
  const std::vector<DimensionTrial>& trials() const { return trials_; } // empty unless asked for

  // #frames by #channels to #frames by #shapes. A missing channel (NaN) is left out of its frame's
  // projection, which is then the least squares over those that are there; a frame of which too
  // little is there for that keeps the weights of the frame before it (the first: zeros).
  FrameMatrixD weights(const FrameMatrixD& channels) const;

private:
  std::optional<Eigen::RowVectorXd> weights_with_gaps(const Eigen::RowVectorXd& frame) const;

  std::vector<std::string> shapes_;
  std::vector<DimensionTrial> trials_; // before pca_, whose choice writes it
  PcaModel pca_;                       // the dimensions in use
  RbfNetwork network_;
  double weight_rms_ = 0.0;
};

} // namespace phonomime
