// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/rig_weights.h"

#include "db/import/readers.h"
#include "db/types/emotion_track.h"
#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/text.h"
#include "synth/retarget/keyshapes/rig_motion.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace phonomime {

namespace {

FrameMatrixD read_keyshapes(const std::filesystem::path& path, const MotionTable& table) {
  const MotionClip clip = read_motion(path);
  const int width = table.layout.channels_per_group();
  FrameMatrixD keyshapes(clip.frame_count(), table.layout.channel_count());
  for (int group = 0; group < table.layout.group_count(); ++group) {
    const std::string& name = table.layout.groups[static_cast<std::size_t>(group)].name;
    const auto found = std::ranges::find(clip.groups, name);
    if (found == clip.groups.end() || clip.channels_per_group != width) {
      throw InputError({.where = path.string(),
                        .what = "the keyshapes have no group " + quoted(name),
                        .expected = "the layout of the database",
                        .remedy = did_you_mean(name, clip.groups)});
    }
    keyshapes.middleCols(group * width, width) =
        clip.frames.middleCols((found - clip.groups.begin()) * width, width).cast<double>();
  }
  if (!keyshapes.allFinite()) {
    throw InputError({.where = path.string(), .what = "a keyshape has missing values"});
  }
  return keyshapes.rowwise() - table.reference_pose.transpose();
}

EmotionMixture spoken_in(const RigChoice& choice, const Rig& rig) {
  if (!choice.emotion.empty()) {
    return parse_emotion_mixture(choice.emotion, "--emotion");
  }
  const std::vector<std::string> expressions = rig_expressions(rig);
  const bool calm = std::ranges::find(expressions, "neutral") != expressions.end();
  return {.heaviest = {.emotion = calm ? "neutral" : expressions.front()}};
}

} // namespace

RigInUse read_rig(const std::filesystem::path& path, const MotionTable& table) {
  RigInUse used{.folder = path.parent_path(),
                .rig = parse_rig(read_file(path), path.string()),
                .keyshapes = {}};
  used.keyshapes = read_keyshapes(used.folder / used.rig.source, table);
  return used;
}

FrameMatrixD decompose_by_rig(const RigInUse& rig, const RigChoice& choice,
                              const WeightChoices& weights, const MotionTable& table,
                              const MotionFile& motion) {
  const EmotionTrack track =
      choice.emotions.empty()
          ? EmotionTrack{}
          : parse_emotion_track(read_file(choice.emotions), choice.emotions.string());
  const FrameMatrixD shares = expression_shares(rig.rig, track, spoken_in(choice, rig.rig),
                                                motion.rate_hz, motion.frame_count());
  return rig_weights(rig.rig, table.layout, rig.keyshapes,
                     motion.channels.rowwise() - table.reference_pose.transpose(), shares,
                     weights.over({.upper = std::numeric_limits<double>::infinity()}));
}

} // namespace phonomime
