// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/dominance_model.h"
#include "tools/evaluate/methods.h"
#include "tools/evaluate/node_motion.h"
#include "tools/evaluate/per_emotion.h"

namespace phonomime {

namespace {

class Dominance : public Method {
public:
  Dominance(const MethodContext& context, const Progress& progress)
      : table_(context.table), models_(context.table, [&](std::int32_t emotion) {
          return fit_dominance(context.table, training_sentences(context.table, emotion),
                               context.threads, progress);
        }) {}

  MethodAnswer say(const SentenceRequest& request, std::size_t, const Progress&) override {
    const FrameMatrixD frames =
        models_.of(request).evaluate(request_anchors(table_, request), request.frame_count);
    return {.sentence = {.method = {},
                         .channels = to_channels(table_.pca, frames, request.frame_count),
                         .joins = {}}};
  }

private:
  const MotionTable& table_;
  PerEmotion<DominanceModel> models_;
};

} // namespace

std::unique_ptr<Method> make_dominance(const MethodContext& context, const Progress& progress) {
  return std::make_unique<Dominance>(context, progress);
}

} // namespace phonomime
