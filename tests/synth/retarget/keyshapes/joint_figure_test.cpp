// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/joint_figure.h"

#include "tests/support/expect_error.h"
#include "tests/synth/retarget/glb_bytes.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// A head with a jaw that rests turned about x, and an arm placed by a matrix.
std::string figure() {
  return test::glb_container(
      R"({"asset":{"version":"2.0"},"extras":{"kept":[1,2]},"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{"name":"head","children":[1,2]},{"name":"jaw","rotation":[0.5,0,0,0.8660254037844386]},)"
      R"({"name":"arm","matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]})",
      "");
}

Rig jaw_rig(const std::string& node, const Quaterniond& open, const Quaterniond& shifted) {
  RigSet set;
  RigKeyshape one, other;
  one.name = "open";
  one.rotations.emplace(node, open);
  other.name = "shifted";
  other.rotations.emplace(node, shifted);
  set.keyshapes = {one, other};
  return {RigTarget::joints, "figure.glb", "k.csv", {set}, {}};
}

// The rotations of the first animation's only channel, read from the bytes by the specification.
std::vector<Quaterniond> rotations_in(const std::string& glb) {
  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, 4);
  const nlohmann::json json = nlohmann::json::parse(glb.substr(20, size));
  std::uint32_t whole = 0;
  std::memcpy(&whole, glb.data() + 8, 4);
  EXPECT_EQ(whole, glb.size());
  EXPECT_EQ(json["extras"]["kept"].size(), 2u);
  const nlohmann::json& animation = json["animations"][0];
  EXPECT_EQ(json["nodes"][animation["channels"][0]["target"]["node"].get<std::size_t>()]["name"],
            "jaw");
  const nlohmann::json& accessor =
      json["accessors"][animation["samplers"][0]["output"].get<std::size_t>()];
  const nlohmann::json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  std::vector<Quaterniond> result;
  for (std::size_t i = 0; i < accessor["count"].get<std::size_t>(); ++i) {
    float q[4];
    std::memcpy(q, glb.data() + 28 + size + view["byteOffset"].get<std::size_t>() + 16 * i, 16);
    result.emplace_back(q[3], q[0], q[1], q[2]);
  }
  return result;
}

TEST(JointFigure, TurnsByTheShareOfAKeyshapesAngle) {
  const Quaterniond rest(AngleAxisd(std::numbers::pi / 3.0, Vector3d::UnitX()));
  const Quaterniond open = rest * Quaterniond(AngleAxisd(0.6, Vector3d::UnitX()));
  const Quaterniond shifted = rest * Quaterniond(AngleAxisd(-0.2, Vector3d::UnitY()));
  const JointFigure figure_glb(figure(), "figure.glb");
  const Rig rig = jaw_rig("jaw", open, shifted);
  const RigTargets targets = figure_glb.targets(rig);
  EXPECT_EQ(targets.names, (std::vector<std::string>{"jaw.x", "jaw.y", "jaw.z"}));
  FrameMatrixD weights(5, 2);
  weights << 0, 0, 1, 0, 0, 1, 0.25, 0, 3.0, 0;
  const std::vector<Quaterniond> found =
      rotations_in(figure_glb.animated(targets, targets.motion(weights), 25.0));
  ASSERT_EQ(found.size(), 5u);
  EXPECT_LT(found[0].angularDistance(rest), 1e-6);
  EXPECT_LT(found[1].angularDistance(open), 1e-6);
  EXPECT_LT(found[2].angularDistance(shifted), 1e-6);
  const Quaterniond quarter = rest * Quaterniond(AngleAxisd(0.15, Vector3d::UnitX()));
  EXPECT_LT(found[3].angularDistance(quarter), 1e-6);
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_GT(found[i].dot(found[i - 1]), 0.0) << "not the short way";
  }
  const std::string csv =
      figure_glb.rotations_csv(targets, targets.motion(weights).topRows(1), 25.0);
  EXPECT_EQ(csv, "time,jaw_qx,jaw_qy,jaw_qz,jaw_qw\n0.0000,0.500000,0.000000,0.000000,0.866025\n");
}

TEST(JointFigure, SaysWhatIsWrong) {
  const JointFigure figure_glb(figure(), "figure.glb");
  const Quaterniond q = Quaterniond::Identity();
  test::expect_error([&] { figure_glb.targets(jaw_rig("jow", q, q)); },
                     R"(figure.glb: the figure has no node "jow". Did you mean "jaw"?)");
  test::expect_error([&] { figure_glb.targets(jaw_rig("arm", q, q)); }, "placed by a matrix");
  test::expect_error([] { JointFigure("not a glb", "x.glb"); },
                     "x.glb: this is not a binary glTF file");
  std::string cut = figure();
  cut.resize(40);
  test::expect_error([&] { JointFigure(cut, "x.glb"); },
                     "x.glb: this binary glTF file is cut short");
  test::expect_error([] { JointFigure(test::glb_container("{}", ""), "x.glb"); }, "list of nodes");
  test::expect_error([] { JointFigure(test::glb_container("[", ""), "x.glb"); }, "x.glb");
}

} // namespace
} // namespace phonomime
