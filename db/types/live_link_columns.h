// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace phonomime {

// The values of a Live Link Face CSV in Epic's order and spelling: ARKit's 52 blendshapes, then 9
// angles of head and eyes. In a file, columns Timecode and BlendShapeCount come before them.
inline constexpr std::array<std::string_view, 61> kLiveLinkColumns = {"EyeBlinkLeft",
                                                                      "EyeLookDownLeft",
                                                                      "EyeLookInLeft",
                                                                      "EyeLookOutLeft",
                                                                      "EyeLookUpLeft",
                                                                      "EyeSquintLeft",
                                                                      "EyeWideLeft",
                                                                      "EyeBlinkRight",
                                                                      "EyeLookDownRight",
                                                                      "EyeLookInRight",
                                                                      "EyeLookOutRight",
                                                                      "EyeLookUpRight",
                                                                      "EyeSquintRight",
                                                                      "EyeWideRight",
                                                                      "JawForward",
                                                                      "JawRight",
                                                                      "JawLeft",
                                                                      "JawOpen",
                                                                      "MouthClose",
                                                                      "MouthFunnel",
                                                                      "MouthPucker",
                                                                      "MouthRight",
                                                                      "MouthLeft",
                                                                      "MouthSmileLeft",
                                                                      "MouthSmileRight",
                                                                      "MouthFrownLeft",
                                                                      "MouthFrownRight",
                                                                      "MouthDimpleLeft",
                                                                      "MouthDimpleRight",
                                                                      "MouthStretchLeft",
                                                                      "MouthStretchRight",
                                                                      "MouthRollLower",
                                                                      "MouthRollUpper",
                                                                      "MouthShrugLower",
                                                                      "MouthShrugUpper",
                                                                      "MouthPressLeft",
                                                                      "MouthPressRight",
                                                                      "MouthLowerDownLeft",
                                                                      "MouthLowerDownRight",
                                                                      "MouthUpperUpLeft",
                                                                      "MouthUpperUpRight",
                                                                      "BrowDownLeft",
                                                                      "BrowDownRight",
                                                                      "BrowInnerUp",
                                                                      "BrowOuterUpLeft",
                                                                      "BrowOuterUpRight",
                                                                      "CheekPuff",
                                                                      "CheekSquintLeft",
                                                                      "CheekSquintRight",
                                                                      "NoseSneerLeft",
                                                                      "NoseSneerRight",
                                                                      "TongueOut",
                                                                      "HeadYaw",
                                                                      "HeadPitch",
                                                                      "HeadRoll",
                                                                      "LeftEyeYaw",
                                                                      "LeftEyePitch",
                                                                      "LeftEyeRoll",
                                                                      "RightEyeYaw",
                                                                      "RightEyePitch",
                                                                      "RightEyeRoll"};
inline constexpr std::size_t kArkitShapeCount = 52;

} // namespace phonomime
