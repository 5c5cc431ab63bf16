// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"

#include <string_view>
#include <vector>

namespace phonomime {

// The channels of a part of the face, ascending: "face" is all of them, "upper" the brows, eyelids
// and forehead, "lower" the lips, jaw, cheeks and nose (T section 3.2 solves these two apart), else
// a region's own name. Groups in both parts count to "lower". Throws InputError for another name,
// or where the layout has no such group.
std::vector<int> part_channels(const Layout& layout, std::string_view part);

// Frames of a part of the face on principal axes of their own, largest variance first, as many as
// move: #frames by #axes. `frames`: #frames by #dimensions, of the whole face's PCA; `channels`: of
// the part. Distances are those of the part's channels. The sign of an axis is such that its
// largest entry is positive.
FrameMatrixD part_coefficients(const PcaModel& pca, const FrameMatrixD& frames,
                               const std::vector<int>& channels);

// What the frames' channels are off the reference pose: #frames by #channels of the part.
// `reference`: #channels of the whole face.
FrameMatrixD part_offsets(const PcaModel& pca, const FrameMatrixD& frames,
                          const std::vector<int>& channels, const Eigen::VectorXd& reference);

// The same offsets on orthonormal axes of their own, so that lengths and scalar products stay what
// they are: #frames by at most #dimensions + 1.
FrameMatrixD part_offset_coordinates(const PcaModel& pca, const FrameMatrixD& frames,
                                     const std::vector<int>& channels,
                                     const Eigen::VectorXd& reference);

} // namespace phonomime
