// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/c3d_bytes.h"
#include "db/import/c3d_parameters.h"

#include <cstddef>

namespace phonomime {

// What the header and the parameters of a C3D file say together about its data section.
struct C3dShape {
  std::size_t points = 0;
  std::size_t frames = 0;
  double first_frame = 1.0; // counted from 1
  double rate_hz = 0.0;
  float scale = 0.0F;     // of integers; negative: the data are floats
  std::size_t analog = 0; // samples in a frame, all channels together
  std::size_t data_begin = 0;

  bool is_float() const { return scale < 0.0F; }
  std::size_t value_bytes() const { return is_float() ? 4 : 2; }
  std::size_t frame_bytes() const { return (4 * points + analog) * value_bytes(); }
};

// Where header and parameters differ the parameters count, as c3d.org asks. Throws InputError for
// values that are not usable and for a data section that does not fit into the file.
C3dShape read_c3d_shape(const C3dBytes& bytes, const C3dParameters& parameters);

} // namespace phonomime
