// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/anchors.h"
#include "tools/evaluate/methods.h"
#include "tools/evaluate/node_motion.h"
#include "tools/evaluate/per_emotion.h"

#include <algorithm>

namespace phonomime {

namespace {

// Straight lines from key to key, held before the first and after the last.
FrameMatrixD interpolate(const std::vector<Anchor>& keys, const FrameMatrixD& poses,
                         Eigen::Index frame_count) {
  FrameMatrixD frames(frame_count, poses.cols());
  std::size_t next = 0; // the first key after the frame
  for (Eigen::Index frame = 0; frame < frame_count; ++frame) {
    const auto at = static_cast<double>(frame);
    while (next < keys.size() && keys[next].frame <= at) {
      ++next;
    }
    const Anchor& after = keys[std::min(next, keys.size() - 1)];
    const Anchor& before = next == 0 ? after : keys[next - 1];
    const double span = after.frame - before.frame;
    const double share = span > 0.0 ? (at - before.frame) / span : 0.0;
    frames.row(frame) = (1.0 - share) * poses.row(before.viseme) + share * poses.row(after.viseme);
  }
  return frames;
}

class VisemeKeyframes : public Method {
public:
  explicit VisemeKeyframes(const MethodContext& context)
      : table_(context.table), poses_(context.table, [&](std::int32_t emotion) {
          return mean_viseme_poses(context.table, training_sentences(context.table, emotion));
        }) {}

  MethodAnswer say(const SentenceRequest& request, std::size_t, const Progress&) override {
    const VisemePoses& poses = poses_.of(request);
    std::vector<Anchor> keys = request_anchors(table_, request);
    std::erase_if(keys, [&](const Anchor& key) {
      return !poses.recorded[static_cast<std::size_t>(key.viseme)];
    });
    if (keys.empty()) {
      keys.push_back({}); // nothing but rest
    }
    return {.sentence = {.method = {},
                         .channels = to_channels(
                             table_.pca, interpolate(keys, poses.poses, request.frame_count),
                             request.frame_count),
                         .joins = {}}};
  }

private:
  const MotionTable& table_;
  PerEmotion<VisemePoses> poses_;
};

} // namespace

std::unique_ptr<Method> make_viseme_keyframes(const MethodContext& context, const Progress&) {
  return std::make_unique<VisemeKeyframes>(context);
}

} // namespace phonomime
