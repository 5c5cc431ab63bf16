// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"
#include "db/types/row_frames.h"
#include "synth/pipeline/transcript_steps.h"
#include "tools/evaluate/methods.h"
#include "tools/evaluate/node_motion.h"

#include <cmath>
#include <tuple>

namespace phonomime {

namespace {

// What is asked of a node, as indices into the table; -1 where the table has no such thing.
struct Wanted {
  std::int32_t phoneme = -1, viseme = -1, emotion = -1;
  std::int32_t previous_phoneme = -1, previous_viseme = -1; // /pau/ at the ends
  std::int32_t next_phoneme = -1, next_viseme = -1;
  std::int64_t frame_count = 1;
};

// How badly a phoneme fits: 0 the same, 1 the same viseme, 2 another.
int misfit(std::int32_t phoneme, std::int32_t wanted_phoneme, std::int32_t viseme,
           std::int32_t wanted_viseme) {
  return phoneme == wanted_phoneme ? 0 : viseme == wanted_viseme ? 1 : 2;
}

// The node of the best phoneme, then emotion, then context, then nearest duration: the first in
// order of key among equals. No look at how nodes join.
class TriphoneMethod : public Method {
public:
  explicit TriphoneMethod(const MethodContext& context)
      : table_(context.table), concat_(context.concat) {
    for (const Phoneme& phoneme : table_.phonemes) {
      viseme_of_.push_back(table_.find_viseme(phoneme.viseme).value_or(-1));
    }
    if (table_.nodes.empty()) {
      throw InputError({.what = "the database has no motion nodes"});
    }
  }

  MethodAnswer say(const SentenceRequest& request, std::size_t, const Progress&) override {
    const std::vector<FrameRange> frames = row_frames(request.rows, table_.rate_hz);
    std::vector<NodeIndex> nodes;
    for (std::size_t i = 0; i < request.rows.size(); ++i) {
      nodes.push_back(
          request.rows[i].is_silence() ? kNoNode : best_node(wanted(request, i, frames[i].count)));
    }
    return {.sentence = say_nodes(table_, request, nodes, concat_)};
  }

private:
  Wanted wanted(const SentenceRequest& request, std::size_t row, std::int64_t frame_count) const {
    const auto phoneme = [&](std::size_t at) {
      return table_.find_phoneme(request.rows[at].phoneme.name).value_or(-1);
    };
    const auto viseme = [&](std::size_t at) {
      return table_.find_viseme(request.rows[at].phoneme.viseme).value_or(-1);
    };
    Wanted wanted{.phoneme = phoneme(row), .viseme = viseme(row), .frame_count = frame_count};
    wanted.emotion =
        find_asked_emotion(table_, {.emotion = std::string(request.emotion)}, "sentence");
    const bool first = row == 0;
    const bool last = row + 1 == request.rows.size();
    wanted.previous_phoneme = first ? 0 : phoneme(row - 1);
    wanted.previous_viseme = first ? viseme_of_[0] : viseme(row - 1);
    wanted.next_phoneme = last ? 0 : phoneme(row + 1);
    wanted.next_viseme = last ? viseme_of_[0] : viseme(row + 1);
    return wanted;
  }

  NodeIndex best_node(const Wanted& wanted) const {
    using Badness = std::tuple<int, int, int, double>;
    NodeIndex best = kNoNode;
    Badness least;
    for (NodeIndex i = 0; i < table_.node_count(); ++i) {
      const MotionNode& node = table_.nodes[static_cast<std::size_t>(i)];
      const Badness badness = {misfit(node.phoneme, wanted.phoneme, node.viseme, wanted.viseme),
                               node.emotion != wanted.emotion,
                               misfit(node.previous_phoneme, wanted.previous_phoneme,
                                      viseme(node.previous_phoneme), wanted.previous_viseme) +
                                   misfit(node.next_phoneme, wanted.next_phoneme,
                                          viseme(node.next_phoneme), wanted.next_viseme),
                               std::abs(std::log(static_cast<double>(node.frame_count) /
                                                 static_cast<double>(wanted.frame_count)))};
      if (best == kNoNode || badness < least) {
        best = i;
        least = badness;
      }
    }
    return best;
  }

  std::int32_t viseme(std::int32_t phoneme) const {
    return viseme_of_[static_cast<std::size_t>(phoneme)];
  }

  const MotionTable& table_;
  ConcatOptions concat_;
  std::vector<std::int32_t> viseme_of_; // per phoneme
};

} // namespace

std::unique_ptr<Method> make_triphone(const MethodContext& context, const Progress&) {
  return std::make_unique<TriphoneMethod>(context);
}

} // namespace phonomime
