// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/keyshapes/region_basis.h"
#include "synth/retarget/keyshapes/rig_motion.h"
#include "synth/retarget/keyshapes/select_keyshapes.h"
#include "tests/synth/retarget/mapping/known_weights.h"

#include <limits>
#include <string>
#include <utility>

namespace phonomime::test {

// Keyshapes chosen from recorded markers whose weights are known: an artist who makes no mistake
// gives the face these weights for each (of a part of the face, those of its shapes), and motion is
// decomposed into them.
class KnownKeyshapes {
public:
  // `channels`: #frames by #channels, mm; `weights`: #frames by #shapes, the truth.
  KnownKeyshapes(const IctFace& ict, const MarkerShapes& shapes, const FrameMatrixD& channels,
                 const FrameMatrixD& weights, const std::vector<std::string>& parts, int count)
      : ict_(ict), reference_(shapes.rest.transpose()) {
    const PcaModel pca = pca_of(channels, 25);
    const FrameMatrixD points = (channels.rowwise() - pca.mean.transpose()) * pca.basis;
    std::vector<Eigen::Index> rows;
    for (const std::string& part : parts) {
      const std::vector<int> own = part_channels(ict.layout, part);
      RigSet set{"neutral", part, {}};
      for (const Keyshape& keyshape :
           select_keyshapes(part_coefficients(pca, points, own), {.count = count}).chosen) {
        RigKeyshape pose;
        pose.source = static_cast<int>(rows.size());
        pose.name = "k" + std::to_string(pose.source);
        for (std::size_t s = 0; s < shapes.names.size(); ++s) {
          const std::string& name = shapes.names[s];
          const bool upper = name.starts_with("brow") || name.starts_with("eye");
          if (part == "face" || upper == (part == "upper")) {
            pose.weights[name] = weights(keyshape.frame, static_cast<Eigen::Index>(s));
          }
        }
        rows.push_back(keyshape.frame);
        set.keyshapes.push_back(std::move(pose));
      }
      rig_.sets.push_back(std::move(set));
    }
    keyshapes_ = channels(rows, Eigen::all).rowwise() - reference_;
  }

  // As other methods have it: #frames by #shapes.
  FrameMatrixD weights(const FrameMatrixD& channels) const {
    const FrameMatrixD found = shape_targets(rig_).motion(
        rig_weights(rig_, ict_.layout, keyshapes_, channels.rowwise() - reference_,
                    FrameMatrixD::Ones(channels.rows(), 1),
                    {.upper = std::numeric_limits<double>::infinity()}));
    FrameMatrixD all = FrameMatrixD::Zero(channels.rows(), std::ssize(ict_.shapes.names));
    const RigTargets targets = shape_targets(rig_);
    for (std::size_t i = 0; i < targets.names.size(); ++i) {
      const auto at = std::ranges::find(ict_.shapes.names, targets.names[i]);
      all.col(at - ict_.shapes.names.begin()) = found.col(static_cast<Eigen::Index>(i));
    }
    return all;
  }

private:
  const IctFace& ict_;
  Eigen::RowVectorXd reference_; // the speaker at rest
  FrameMatrixD keyshapes_;       // offsets
  Rig rig_;
};

} // namespace phonomime::test
