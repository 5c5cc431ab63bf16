// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "db/types/layout.h"

namespace phonomime::demo {

// A vertical cut through the lips. Markers are named by their vertex of the canonical face mesh.
struct LipColumn {
  int upper_outer;
  int upper_inner;
  int lower_inner; // meets upper_inner where the lips close
  int lower_outer;
};

// From the right corner (left of the picture) to the left one.
inline constexpr std::array<LipColumn, 9> kLipColumns = {{{185, 191, 95, 146},
                                                          {40, 80, 88, 91},
                                                          {39, 81, 178, 181},
                                                          {37, 82, 87, 84},
                                                          {0, 13, 14, 17},
                                                          {267, 312, 317, 314},
                                                          {269, 311, 402, 405},
                                                          {270, 310, 318, 321},
                                                          {409, 415, 324, 375}}};

// Corners of the mouth.
inline constexpr int kOuterCornerRight = 61;
inline constexpr int kInnerCornerRight = 78;
inline constexpr int kOuterCornerLeft = 291;
inline constexpr int kInnerCornerLeft = 308;

// Vertices of the canonical mesh that carry markers, in the order of the layout: marker lmN is
// vertex N. 91 of them.
std::span<const int> marker_vertices();

// Index into marker_vertices() of vertex N. Throws InternalError where it carries no marker.
int marker_index(int vertex);

std::string marker_name(int vertex);

// Regions, landmarks and reference marker of the 91 markers; mm, x right, y up, z to the viewer.
Layout marker_layout();

} // namespace phonomime::demo
