// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

namespace phonomime {

// frames' * frames: #channels by #channels, entry (i, j) the sum over frames of channel i times
// channel j, symmetric. Every sum is taken in an order that is fixed by the source, so that neither
// the number of threads (0: as many as there are) nor the processor changes a bit.
Eigen::MatrixXd frame_products(const Eigen::Ref<const FrameMatrixD>& frames, int threads);

} // namespace phonomime
