// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/search_session.h"
#include "synth/search/viterbi_search.h"
#include "tests/bench/compare.h"
#include "tests/bench/scale/measure.h"
#include "tests/bench/scale/sections.h"

#include <algorithm>

namespace phonomime::bench {

namespace {

struct Edit {
  std::string name;
  std::vector<SearchStep> steps;
};

// One constraint, one ban, one other emotion, at the start, in the middle and at the end.
std::vector<Edit> edits_of(const Subject& subject, const Phrase& phrase,
                           const SearchResult& first) {
  const auto emotions = static_cast<std::int32_t>(subject.table.emotions.size());
  const std::size_t steps = phrase.steps.size();
  const std::vector<std::pair<std::string, std::size_t>> places = {
      {"start", 0}, {"middle", steps / 2}, {"end", steps - 1}};
  std::vector<Edit> edits;
  for (const auto& [place, at] : places) {
    Edit use{"use, " + place, phrase.steps};
    use.steps[at].allowed = {first.runners_up[at].front().node};
    Edit ban{"ban, " + place, phrase.steps};
    ban.steps[at].avoided = {first.path.nodes[at]};
    edits.push_back(std::move(use));
    edits.push_back(std::move(ban));
    if (emotions > 1) {
      Edit emotion{"emotion, " + place, phrase.steps};
      emotion.steps[at].emotion = (emotion.steps[at].emotion + 1) % emotions;
      edits.push_back(std::move(emotion));
    }
  }
  return edits;
}

} // namespace

void report_edits(Report& report, const ScaleOptions& options, const std::vector<Subject>& all) {
  report.section(
      "Edits: one step changed after a first search (ms, warm, 2 threads; undo = back "
      "again; full = a search of the edited steps)",
      {"database        ", "phrase", "edit           ", "edited", "undo", "full", "full/edited"});
  for (const Subject& subject : all) {
    ViterbiSearch search(subject.table, subject.weights);
    std::vector<double> of_subject;
    for (const Phrase& phrase : subject.phrases) {
      const SearchResult first = search.solve(phrase.steps, {.threads = 2, .runners_up = 1});
      for (const Edit& edit : edits_of(subject, phrase, first)) {
        SearchSession session(search);
        const SearchOptions two_threads{.threads = 2};
        verify(same_path(session.solve(phrase.steps, two_threads).path, first.path),
               "a session's first answer is not that of the search");
        const NodePath answer = search.solve(edit.steps, two_threads).path;
        verify(same_path(session.solve(edit.steps, two_threads).path, answer),
               subject.name + ", " + phrase.name + ", " + edit.name +
                   ": the session's answer is not that of the full search");
        verify(same_path(session.solve(phrase.steps, two_threads).path, first.path),
               "an undone edit leaves another answer");
        std::vector<double> edited;
        std::vector<double> undone;
        std::vector<double> full;
        for (int run = 0; run < options.runs; ++run) {
          edited.push_back(1e3 * seconds([&] { return session.solve(edit.steps, two_threads); }));
          undone.push_back(1e3 * seconds([&] { return session.solve(phrase.steps, two_threads); }));
          full.push_back(1e3 * seconds([&] { return search.solve(edit.steps, two_threads); }));
        }
        of_subject.push_back(median(edited));
        report.row({subject.name, phrase.name, edit.name, median(edited), median(undone),
                    median(full), median(full) / median(edited)});
      }
    }
    report.note(
        subject.name + ": " +
        std::to_string(std::ranges::count_if(of_subject, [](double ms) { return ms <= 50; })) +
        " of " + std::to_string(of_subject.size()) + " edits within 50 ms");
  }
}

} // namespace phonomime::bench
