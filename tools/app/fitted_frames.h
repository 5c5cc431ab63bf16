// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/retarget/shape_face.h"

#include <filesystem>

namespace phonomime {

// Weights of a face's shapes for frames that stand alone, by a direct fit (ShapeFit) without
// smoothness from one to the next: #frames by #shapes, for an artist to begin with. `channels`:
// #frames by #channels of a layout of markers; `path`: the face's, beside which markers are
// looked for. Throws InputError and IoError.
FrameMatrixD fitted_frames(const ShapeFace& face, const std::filesystem::path& path,
                           const MotionTable& table, const FrameMatrixD& channels);

} // namespace phonomime
