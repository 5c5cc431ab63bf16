// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"

#include <vector>

namespace phonomime {

// Where a group stands, told by its neighbours: a linear prediction of each group's channels from
// those of the 8 groups nearest to it (weights: most correlated with it), and of up to 2 others
// that move with what these leave over (the other eyelid in a blink), learned from frames of one
// speaker. A marker of a living face is tied to the skin around it, so that what is left over,
// the residual, is small whatever the face says; of a marker that was swapped, lost or dragged away
// it is not. The fit is a ridge regression, repeated without the tenth of the frames that fit worst
// (trimmed least squares): a few contaminated frames do not bend it.
class NeighbourModel {
public:
  // `frames`: #frames by #channels, without gaps. Too few frames (under 200) or groups (under 2)
  // give a model that knows nothing: see known(). The same at any number of threads (0: as many as
  // there are).
  NeighbourModel(const FrameMatrix& frames, const Layout& layout, int threads);

  bool known() const { return known_; }

  // #frames by #channels: each group's channels minus what its neighbours predict.
  FrameMatrixD residuals(const FrameMatrix& frames) const;

  // The residual's length beyond which a group's place is not believed, and its usual length (the
  // median over the frames that the model was learned from); mm or weight.
  double limit(int group) const { return limit_[static_cast<std::size_t>(group)]; }
  double usual(int group) const { return usual_[static_cast<std::size_t>(group)]; }

  // Takes a displacement of `group` (its channels; mm or weight) off one frame of residuals: off
  // its own and off those that it has led astray.
  void take_off(int group, const Eigen::VectorXd& displacement, double* residual) const;

private:
  struct Fit {
    std::vector<int> neighbours; // groups
    Eigen::MatrixXd weights;     // (#neighbours * width) by width
  };
  struct Reader {
    int group = 0;    // that is predicted from this one,
    int position = 0; // which is its neighbour number `position`
  };

  void choose_nearest(const FrameMatrixD& centred);
  void add_companions(const FrameMatrixD& centred, int threads);
  // What the prediction leaves over: #frames by #channels of a group.
  FrameMatrixD fit(int group, const FrameMatrixD& centred);

  bool known_ = false;
  bool markers_ = true;
  int width_ = 3;
  Eigen::VectorXd centre_; // #channels: the median frame
  std::vector<Fit> fits_;
  std::vector<std::vector<Reader>> readers_; // by group
  std::vector<double> usual_, limit_;
};

} // namespace phonomime
