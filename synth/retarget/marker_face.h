// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"
#include "synth/retarget/face_source.h"
#include "synth/retarget/inner_parts.h"
#include "synth/retarget/jaw_motion.h"
#include "synth/retarget/marker_spread.h"
#include "synth/retarget/opening_cut.h"
#include "synth/retarget/placement.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// A mesh whose shape is base + sum over d of coefficient d times morphs[d]: each #vertices by 3,
// mm.
struct MorphTargets {
  Points base;
  std::vector<Points> morphs;

  // The shape at some coefficients (#dimensions).
  Points at(const Eigen::VectorXd& coefficients) const;
};

// What was found and done when a face was fitted to a layout.
struct MarkerFaceReport {
  bool automatic_markers = false;           // placed by their names
  std::vector<std::string> missing_markers; // of the layout, not on the face
  std::vector<std::string> unknown_markers; // of the table, not in the layout
  Similarity placement;                     // of the mesh onto the reference pose; rms in mm
  std::vector<FilledOpening> cut;
  double largest_offset_mm = 0.0; // that brought lips and eyelids to the reference pose
  InnerParts inner;               // teeth, gums, eyes, lashes: vertices moved out
};

// A face driven by markers (DESIGN section 7): placed on the reference pose by a similarity, mouth
// and eyes cut open, lips and eyelids brought to the reference pose, then moved by E14-E15. In mm
// in the markers' own axes (x to the right of the picture, y up, z towards the camera), head at
// rest.
//
// Everything here is linear in the markers, so E11 makes it a base and one morph per PCA dimension.
class MarkerFace {
public:
  // `reference_pose`: #channels of the layout. Throws InputError where the markers do not fit the
  // mesh (the similarity leaves more than a quarter of their spread).
  MarkerFace(FaceSource source, const Layout& layout, const Eigen::VectorXd& reference_pose,
             const SpreadOptions& options = {});

  // At the reference pose: cut, positions in mm. Vertices keep the numbers that the file gave them.
  const TriangleMesh& mesh() const { return mesh_; }
  const MarkerFaceReport& report() const { return report_; }

  // Vertex of each landmark of the layout that the face has.
  const std::map<std::string, int, std::less<>>& landmarks() const { return landmarks_; }

  // E15 on a frame of markers (#channels, mm): #vertices by 3, mm.
  Points deform(const Eigen::VectorXd& channels) const;

  // E11 and E15 together: at(c) equals deform(pca.reconstruct(c)).
  MorphTargets morphs(const PcaModel& pca) const;

  // The share of the aperture's deviation from the reference pose that the mesh keeps at the inner
  // lips' landmarks: the slope of the mesh's deviation on the markers' over the motion that the
  // PCA describes (its mean and variances). Nothing where the landmarks are not on the face.
  std::optional<double> aperture_share(const PcaModel& pca) const;

private:
  Points displacements(const Eigen::VectorXd& channels) const;
  void sort_inner();
  void bring_to_reference(const Points& reference);
  std::vector<int> groups_on_face(Region region) const;
  std::array<std::vector<int>, 2> eyelids_by_side() const; // groups: right eye, left eye

  Layout layout_;
  Eigen::VectorXd reference_pose_;
  TriangleMesh mesh_;
  std::vector<int> marker_vertices_;
  SpreadWeights weights_; // #vertices by #markers; rows outside the skin are empty
  std::vector<InnerVertex> inner_;
  std::vector<int> jaw_markers_; // into the layout's groups
  JawMotion jaw_;
  std::map<std::string, int, std::less<>> landmarks_;
  MarkerFaceReport report_;
};

} // namespace phonomime
