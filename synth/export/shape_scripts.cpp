// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/shape_files.h"

#include <iterator>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

// JSON strings are Python's too.
std::string python_string(std::string_view text) {
  return nlohmann::json(std::string(text))
      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// NAMES, WEIGHTS (a row for each frame), RATE and HEAD (rows of three places in the face's unit and
// three angles in degrees: yaw, pitch, roll; empty where the head rests).
std::string data_lines(const ShapeMotion& motion, std::string_view face) {
  std::string text = fmt::format("FACE = {}\nRATE = {:.9g}  # frames a second\nNAMES = [\n",
                                 python_string(face), motion.weights.rate_hz);
  for (const std::string& name : motion.weights.groups) {
    text += fmt::format("    {},\n", python_string(name));
  }
  text += "]\nWEIGHTS = [  # a row for each frame\n";
  for (Eigen::Index frame = 0; frame < motion.weights.frames.rows(); ++frame) {
    text += "    [";
    for (const float weight : motion.weights.frames.row(frame)) {
      fmt::format_to(std::back_inserter(text), "{:.6g},", weight);
    }
    text += "],\n";
  }
  text += "]\nHEAD = [  # x, y, z in the face's unit; yaw, pitch, roll in degrees (Y X Z)\n";
  for (const HeadPose& head : motion.head) {
    const FacePose pose = pose_on_face(head, motion.placement);
    const HeadAngles angles = head_angles(pose.rotation);
    fmt::format_to(std::back_inserter(text), "    [{:.9g},{:.9g},{:.9g},{:.6f},{:.6f},{:.6f}],\n",
                   pose.translation.x(), pose.translation.y(), pose.translation.z(),
                   kDegrees * angles.yaw, kDegrees * angles.pitch, kDegrees * angles.roll);
  }
  return text + "]\n";
}

constexpr std::string_view kHeading = R"(# -*- coding: utf-8 -*-
# Made by Phonomime: keys the shapes of a face, and its head.
)";

constexpr std::string_view kMaya = R"(
# Run it in Maya's script editor with the face in the scene. Shapes are the targets of any
# blendShape node that bear these names. The head is keyed on the transform `phonomime_head`; parent
# the face under it, or rename your own head's transform to it. HEAD is in the unit of the face's
# file: give another as HEAD_UNIT where the scene has one (a GLB is in metres, Maya in centimetres).

import maya.cmds as cmds
import maya.mel as mel

HEAD_UNIT = 100.0
HEAD_NODE = "phonomime_head"


def targets():
    found = {}
    for node in cmds.ls(type="blendShape") or []:
        for target in cmds.listAttr(node + ".weight", multi=True) or []:
            found.setdefault(target.split("|")[-1].split(":")[-1], []).append(node + "." + target)
    return found


def key_all():
    found = targets()
    missing = [name for name in NAMES if name not in found]
    if len(missing) == len(NAMES):
        raise RuntimeError("no blendShape node of this scene has one of the shapes: " + ", ".join(NAMES[:5]))
    for name in missing:
        cmds.warning("no shape " + name + " in this scene")
    scene_rate = mel.eval("currentTimeUnitToFPS")
    for frame, row in enumerate(WEIGHTS):
        time = frame / RATE * scene_rate
        for name, weight in zip(NAMES, row):
            for plug in found.get(name, []):
                cmds.setKeyframe(plug, time=time, value=weight)
    if HEAD:
        if not cmds.objExists(HEAD_NODE):
            cmds.group(empty=True, name=HEAD_NODE)
        cmds.setAttr(HEAD_NODE + ".rotateOrder", 2)  # zxy: roll, pitch, yaw
    for frame, row in enumerate(HEAD):
        time = frame / RATE * scene_rate
        values = [HEAD_UNIT * place for place in row[:3]] + [row[4], row[3], row[5]]
        plugs = ("translateX", "translateY", "translateZ", "rotateX", "rotateY", "rotateZ")
        for plug, value in zip(plugs, values):
            cmds.setKeyframe(HEAD_NODE + "." + plug, time=time, value=value)


key_all()
)";

constexpr std::string_view kBlender = R"(
# Run it in Blender's text editor with the face in the scene (File > Import > glTF 2.0), or with
# `blender --background scene.blend --python THIS`. Shapes are the shape keys of any mesh that bear
# these names. The head is keyed on the object `phonomime_head`, an empty that is made where there is
# none; the meshes are parented under it. Blender's z is up: places and angles are turned.

import math

import bpy
from mathutils import Matrix, Vector

HEAD_UNIT = 1.0
HEAD_NODE = "phonomime_head"


def key_curve(block, path, times, values):
    if block.animation_data is None:
        block.animation_data_create()
    if block.animation_data.action is None:
        block.animation_data.action = bpy.data.actions.new("speech")
    curves = block.animation_data.action.fcurves
    for index, column in enumerate(values):
        old = curves.find(path, index=index)
        if old is not None:
            curves.remove(old)
        curve = curves.new(path, index=index)
        curve.keyframe_points.add(len(times))
        curve.keyframe_points.foreach_set("co", [x for pair in zip(times, column) for x in pair])
        curve.update()


def key_all():
    scene = bpy.context.scene
    scene_rate = scene.render.fps / scene.render.fps_base
    times = [1 + frame / RATE * scene_rate for frame in range(len(WEIGHTS))]
    keyed, faces = set(), []
    for thing in scene.objects:
        keys = thing.data.shape_keys if thing.type == "MESH" else None
        blocks = keys.key_blocks if keys else {}
        own = [name for name in NAMES if name in blocks]
        for name in own:
            blocks[name].slider_min = min(blocks[name].slider_min, 0.0)
            column = [row[NAMES.index(name)] for row in WEIGHTS]
            key_curve(keys, 'key_blocks["%s"].value' % bpy.utils.escape_identifier(name), times, [column])
        if own:
            keyed.update(own)
            faces.append(thing)
    if not keyed:
        raise RuntimeError("no mesh of this scene has one of the shapes: " + ", ".join(NAMES[:5]))
    for name in NAMES:
        if name not in keyed:
            print("no shape %s in this scene" % name)
    scene.frame_end = max(scene.frame_end, math.ceil(times[-1]))
    if HEAD:
        head = scene.objects.get(HEAD_NODE)
        if head is None:
            head = bpy.data.objects.new(HEAD_NODE, None)
            scene.collection.objects.link(head)
        for face in faces:
            while face.parent is not None and face.parent is not head:
                face = face.parent
            if face is not head and face.parent is None:
                face.parent = head
        head.rotation_mode = "QUATERNION"
        up = Matrix(((1, 0, 0), (0, 0, -1), (0, 1, 0)))  # y up to z up
        places, turns = [], []
        for x, y, z, yaw, pitch, roll in HEAD:
            turn = Matrix.Rotation(math.radians(yaw), 3, "Y") @ Matrix.Rotation(math.radians(pitch), 3, "X")
            turn = turn @ Matrix.Rotation(math.radians(roll), 3, "Z")
            quaternion = (up @ turn @ up.transposed()).to_quaternion()
            if turns and quaternion.dot(turns[-1]) < 0:
                quaternion.negate()
            turns.append(quaternion)
            places.append(HEAD_UNIT * (up @ Vector((x, y, z))))
        key_curve(head, "location", times, list(zip(*places)))
        key_curve(head, "rotation_quaternion", times, list(zip(*turns)))


key_all()
)";

} // namespace

std::string maya_script(const ShapeMotion& motion, std::string_view face) {
  return fmt::format("{}{}{}", kHeading, data_lines(motion, face), kMaya);
}

std::string blender_script(const ShapeMotion& motion, std::string_view face) {
  return fmt::format("{}{}{}", kHeading, data_lines(motion, face), kBlender);
}

} // namespace phonomime
