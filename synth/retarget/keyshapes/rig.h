// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace phonomime {

// What a target does is said by weights of its blendshapes, by meshes, by rotations of glTF nodes,
// or by SVG drawings.
enum class RigTarget { shapes, mesh, joints, drawing };
inline constexpr std::array<std::string_view, 4> kRigTargetNames = {"shapes", "mesh", "joints",
                                                                    "drawing"};

// What the target does for one source keyshape.
struct RigKeyshape {
  std::string name;
  int source = 0; // row of the rig's source file, counted from 0
  std::map<std::string, double, std::less<>> weights; // of shapes
  std::string file;                                   // of a mesh or a drawing
  // Of joints: a node's rotation under its parent, in place of the one that the file has.
  std::map<std::string, Eigen::Quaterniond, std::less<>> rotations;
};

// Keyshapes of one expression and one part of the face, decomposed together.
struct RigSet {
  std::string expression = "neutral";
  std::string part = "face"; // part_channels
  std::vector<RigKeyshape> keyshapes;
};

// Heights (y, of a mesh, in its own unit) between which the parts "lower" and "upper" pass into one
// another by linear weights (T section 3.2).
struct RigSeam {
  double from = 0.0; // at and below: lower alone
  double to = 0.0;   // at and above: upper alone
};

struct Rig {
  RigTarget target = RigTarget::shapes;
  std::string file;   // of the target at rest; none for shapes
  std::string source; // motion file with the source keyshapes, one a row
  std::vector<RigSet> sets;
  std::optional<RigSeam> seam;
};

// A rig's text (corpora_schema/rig.md), checked against its schema and for repeated names, sets and
// expressions. `where` names the file in errors. Throws InputError.
Rig parse_rig(std::string_view json_text, std::string_view where);

// The text that parse_rig reads back as the same rig.
std::string format_rig(const Rig& rig);

} // namespace phonomime
