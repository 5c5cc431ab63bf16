// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "synth/retarget/triangle_mesh.h"

#include <span>
#include <string>
#include <vector>

namespace phonomime {

// An opening of the face (mouth, eye) that triangles were found to fill.
struct FilledOpening {
  std::string name;  // "mouth", "right eye", "left eye"
  int triangles = 0; // how many fill it
};

struct OpeningFill {
  std::vector<char> filling; // #triangles of the mesh, 1 = fills an opening
  std::vector<FilledOpening> openings;
};

// The triangles of the skin that fill the mouth or an eye (DESIGN section 7): uncut, the shortest
// path from the upper to the lower lip leads across the mouth and E15 glues the lips together.
//
// Where the markers' names are vertex numbers and the mesh has the rings of the 468-vertex
// canonical face, those rings are the openings' edges, and what lies inside is the fill. Elsewhere
// an opening is filled where the way over the mesh from its upper to its lower marker is shorter
// than half the way by its nearer corner; the fill is then what lies, seen from the front, between
// the upper, the lower and the corner markers, as far as it hangs together with that way.
//
// `positions` (#vertices by 3): the mesh placed on the markers (x to the right of the picture, y
// up). `marker_vertices` as in MarkerMap.
OpeningFill find_opening_fill(const TriangleMesh& mesh, const Points& positions,
                              const Layout& layout, std::span<const int> marker_vertices);

} // namespace phonomime
