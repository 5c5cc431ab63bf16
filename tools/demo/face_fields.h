// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/demo/dominance.h"
#include "tools/demo/emotion_style.h"
#include "tools/demo/rest_pose.h"

namespace phonomime::demo {

// Everything that moves the skin at one frame.
struct FaceState {
  ArticulatoryFrame speech;
  Expression expression;
  double intensity = 1.0; // of the expression
  double blink = 0.0;     // 0 as the expression has it, 1 shut
};

// Turns states into marker positions: smooth displacement fields over the markers at rest, the jaw
// about an effective hinge, the lips column by column so that an aperture of 0 makes the inner
// markers of every column meet. `rigid` markers do not move.
class FaceFields {
public:
  // `rest`: #markers by 3, mm, lips closed.
  explicit FaceFields(MarkerPose rest);

  const MarkerPose& rest() const { return rest_; }

  // #markers by 3, mm, free of head motion.
  MarkerPose pose(const FaceState& state) const;

private:
  struct Mouth;
  void move_lips(const FaceState& state, const Mouth& mouth, MarkerPose& pose) const;
  void move_skin(const FaceState& state, const Mouth& mouth, MarkerPose& pose) const;
  void move_eyes(const FaceState& state, MarkerPose& pose) const;

  MarkerPose rest_;
};

} // namespace phonomime::demo
