// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/curation/neighbour_model.h"
#include "db/curation/phoneme_clusters.h"
#include "db/types/layout.h"
#include "db/types/stored_sentence.h"
#include "db/types/suspect_mark.h"

#include <map>
#include <string>
#include <vector>

namespace phonomime {

// A node with the marks that the channels give it.
struct JudgedNode {
  std::size_t sentence = 0; // in the order of the second pass
  std::int32_t row = 0;
  std::vector<SuspectMark> marks; // at least one, each reason once, in order of reason
};

// Finds contaminated nodes in the stored channels of a database (not in its PCA, which hides single
// markers), in two passes over all of its sentences: learn() each, settle(), look() at each again,
// then judge(). Pruned nodes and frames with gaps teach nothing, but pruned nodes are judged too.
//
//   SuspectJudge judge(layout, rate_hz);
//   for (sentence) judge.learn(sentence);
//   judge.settle(threads);
//   for (sentence) looked.push_back(judge.look(sentence));
//   judge.judge(looked, threads);
//
// The same sentences in the same order give the same marks, at any thread count.
class SuspectJudge {
public:
  SuspectJudge(Layout layout, double rate_hz);

  void learn(const StoredSentence& sentence);
  // After the last sentence of the first pass.
  void settle(int threads);

  // What a sentence shows by itself, and what its nodes are to be compared by.
  struct Look {
    std::vector<std::int32_t> rows;
    std::vector<NodeMeasures> measures;                        // by node
    std::vector<std::vector<SuspectMark>> own;                 // by node
    std::vector<std::pair<std::int32_t, std::int32_t>> frames; // by node: first, count
    std::vector<std::string> phonemes;                         // by node
  };
  // Second pass. May be called by several threads at once. Throws InternalError for a speaker who
  // was not learned.
  Look look(const StoredSentence& sentence) const;

  // Suspects in order of (sentence, row). Empties `looks`.
  std::vector<JudgedNode> judge(std::vector<Look>&& looks, int threads) const;

private:
  // Frames of one speaker to learn from, thinned out as they become many.
  struct Sample {
    std::vector<Eigen::RowVectorXf> frames;
    std::vector<std::vector<float>> steps; // by group: from a frame to the next, mm or weight
    std::int64_t stride = 1, seen = 0;
  };
  struct Learned {
    NeighbourModel model;
    std::vector<double> usual_step; // by group: 99 % stay under it
  };

  void add_displaced(const StoredSentence& sentence, const Learned& learned, Look& look) const;
  void add_still(const StoredSentence& sentence, Look& look) const;
  void measure_steps(const StoredSentence& sentence, const Learned& learned, Look& look) const;
  std::string group_name(int group) const;

  Layout layout_;
  double rate_hz_ = 0.0;
  std::vector<int> pose_groups_;
  std::map<std::string, Sample> samples_;  // by speaker
  std::map<std::string, Learned> learned_; // by speaker
};

} // namespace phonomime
