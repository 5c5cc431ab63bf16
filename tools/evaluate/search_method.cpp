// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/synthesize.h"
#include "tools/evaluate/methods.h"
#include "tools/evaluate/node_motion.h"

#include <utility>

namespace phonomime {

namespace {

// The recipe of `synth`, with the recording's own transcript and emotion.
class SearchMethod : public Method {
public:
  SearchMethod(const MethodContext& context, const CostWeights& weights, int blend)
      : table_(context.table), weights_(weights), blend_(blend), concat_(context.concat),
        searches_(context.workers) {}

  MethodAnswer say(const SentenceRequest& request, std::size_t worker,
                   const Progress& progress) override {
    std::unique_ptr<ViterbiSearch>& search = searches_[worker];
    if (!search) {
      search = std::make_unique<ViterbiSearch>(table_, weights_);
    }
    SynthesisInput input;
    input.transcript.assign(request.rows.begin(), request.rows.end());
    input.emotions.assign(request.rows.size(), {.emotion = std::string(request.emotion)});
    input.weights = weights_;
    input.blend = blend_;
    input.search.threads = 1; // sentences are shared out
    input.concat = concat_;
    input.fps = table_.rate_hz;
    const SynthesisResult result = synthesize(table_, *search, input, progress);
    std::vector<NodeIndex> nodes;
    for (const PathRow& row : result.rows) {
      nodes.push_back(row.node);
    }
    return {.sentence = {.method = {},
                         .channels = to_channels(table_.pca, result.motion.coefficients,
                                                 request.frame_count),
                         .joins = join_places(table_, request.rows, nodes)},
            .search_s = result.search_seconds};
  }

private:
  const MotionTable& table_;
  CostWeights weights_;
  int blend_;
  ConcatOptions concat_;
  std::vector<std::unique_ptr<ViterbiSearch>> searches_; // one a worker
};

} // namespace

std::unique_ptr<Method> make_default(const MethodContext& context, const Progress&) {
  return std::make_unique<SearchMethod>(context, context.weights, context.blend);
}

std::unique_ptr<Method> make_one_path(const MethodContext& context, const Progress&) {
  return std::make_unique<SearchMethod>(context, context.weights, 1);
}

std::unique_ptr<Method> make_paper(const MethodContext& context, const Progress&) {
  return std::make_unique<SearchMethod>(context, context.paper_weights, 1);
}

} // namespace phonomime
