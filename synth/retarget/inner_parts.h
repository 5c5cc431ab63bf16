// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/triangle_mesh.h"

#include <optional>
#include <vector>

namespace phonomime {

// Where a mouth or an eye is, on an upright mesh in mm (x to the right of the picture, y up, z
// forward).
struct MouthPlace {
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero(); // between the inner lips
  double half_width = 0.0;                                // from the centre to a corner
  double chin_y = 0.0;
};
struct EyePlace {
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero(); // mean of the eyelids' markers
  double radius = 0.0;                                    // to the farthest of them
};
struct FacePlaces {
  std::optional<MouthPlace> mouth;
  std::vector<EyePlace> eyes;
};

inline constexpr int kNowhere = -1;
inline constexpr int kInMouth = 0;
inline constexpr int kInFirstEye = 1; // and so on, in the order of FacePlaces::eyes

// What moves a vertex that is not skin.
struct InnerVertex {
  double jaw = 0.0;     // its share of the jaw's motion, 0 (rests with the head) to 1
  int anchor = -1;      // the vertex of the skin that it follows, -1 = none
  int place = kNowhere; // what its piece lies in
};

struct InnerParts {
  std::vector<InnerVertex> vertices; // #vertices outside the skin, from the first one on
  int resting = 0;                   // how many pieces rest with the head: eyes, upper teeth
  int jaw = 0;                       // follow the lower jaw: lower teeth
  int shared = 0;                    // lie between both: gums in one piece
  int anchored = 0;                  // grow on the skin: lashes
};

// Sorts the pieces (connected components, coincident vertices welded) of all parts but the skin by
// where they are. A piece of which a tenth of the vertices lie on vertices of the skin grows on it.
// A piece inside the mouth follows the jaw where it lies below the mouth's line, rests where it
// lies above; one with more than a third of its height on either side is shared out by the squared
// distances to the nearest resting and the nearest following piece in the mouth. The rest rests; a
// piece whose middle is within an eye's radius of its centre lies in that eye.
// `positions`: #vertices by 3.
InnerParts sort_inner_parts(const TriangleMesh& mesh, const Points& positions,
                            const FacePlaces& places);

} // namespace phonomime
