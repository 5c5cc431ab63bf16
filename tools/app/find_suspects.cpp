// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/find_suspects.h"

#include "db/curation/suspect_judge.h"
#include "db/types/parallel_for.h"

#include <utility>

namespace phonomime {

namespace {

constexpr std::size_t kSentencesAtOnce = 16;
constexpr std::string_view kStage = "looking for suspects";

} // namespace

std::vector<NodeMarks> find_suspects(const EachStoredSentence& each, const Layout& layout,
                                     double rate_hz, int threads, const Progress& progress) {
  SuspectJudge judge(layout, rate_hz);
  std::vector<std::int64_t> ids;
  each([&](const StoredSentence& sentence) {
    if (progress.stop_requested()) {
      throw Interrupted();
    }
    judge.learn(sentence);
    ids.push_back(sentence.id);
  });
  judge.settle(threads);

  std::vector<SuspectJudge::Look> looks;
  std::vector<StoredSentence> some;
  const auto look_at_some = [&] {
    const std::size_t first = looks.size();
    progress.update(kStage, static_cast<std::int64_t>(first),
                    static_cast<std::int64_t>(ids.size()));
    looks.resize(first + some.size());
    parallel_for(static_cast<std::ptrdiff_t>(some.size()), threads, [&](std::ptrdiff_t i) {
      looks[first + static_cast<std::size_t>(i)] = judge.look(some[static_cast<std::size_t>(i)]);
    });
    some.clear();
  };
  each([&](const StoredSentence& sentence) {
    some.push_back(sentence);
    if (some.size() == kSentencesAtOnce) {
      look_at_some();
    }
  });
  look_at_some();

  std::vector<NodeMarks> marks;
  for (JudgedNode& node : judge.judge(std::move(looks), threads)) {
    marks.push_back(
        {.sentence_id = ids[node.sentence], .row = node.row, .marks = std::move(node.marks)});
  }
  return marks;
}

} // namespace phonomime
