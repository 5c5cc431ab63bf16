// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"
#include "db/types/row_frames.h"
#include "tools/evaluate/methods.h"
#include "tools/evaluate/nearest_nodes.h"
#include "tools/evaluate/node_motion.h"

namespace phonomime {

namespace {

// Per phoneme the node, of whatever phoneme, that is nearest to the recording; joined as others.
class Oracle : public Method {
public:
  explicit Oracle(const MethodContext& context)
      : table_(context.table), concat_(context.concat), nearest_(context.table) {}

  MethodAnswer say(const SentenceRequest& request, std::size_t, const Progress&) override {
    if (request.recorded == nullptr) {
      throw InternalError({.what = "the oracle needs the recording"});
    }
    const FrameMatrixD recorded =
        (request.recorded->cast<double>().rowwise() - table_.pca.mean.transpose()) *
        table_.pca.basis;
    const std::vector<FrameRange> frames = row_frames(request.rows, table_.rate_hz);
    std::vector<FrameMatrixD> stretches;
    for (std::size_t i = 0; i < request.rows.size(); ++i) {
      if (!request.rows[i].is_silence()) {
        stretches.emplace_back(recorded.middleRows(frames[i].first, frames[i].count));
      }
    }
    const std::vector<NodeIndex> found = nearest_.find(stretches);
    std::vector<NodeIndex> nodes;
    std::size_t next = 0;
    for (const TimedPhoneme& row : request.rows) {
      nodes.push_back(row.is_silence() ? kNoNode : found[next++]);
    }
    return {.sentence = say_nodes(table_, request, nodes, concat_)};
  }

private:
  const MotionTable& table_;
  ConcatOptions concat_;
  NearestNodes nearest_;
};

} // namespace

std::unique_ptr<Method> make_oracle(const MethodContext& context, const Progress&) {
  return std::make_unique<Oracle>(context);
}

} // namespace phonomime
