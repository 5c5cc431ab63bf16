// SPDX-License-Identifier: GPL-3.0-or-later
// Prints the tables of docs/style.md: style models of grid_s1_expressive, judged on sentences that
// neither the PCA nor the models have seen.
#include "db/types/percentile.h"
#include "tests/support/shared_data.h"
#include "tests/synth/style/judged_styles.h"
#include "tools/app/folds.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <set>
#include <string>

#include <fmt/format.h>

namespace {

using namespace phonomime;
using namespace phonomime::test;

using Squares = PairError::Squares;

struct Totals {
  std::vector<PairError> pairs;
  std::vector<LipFigures> lips;
  std::vector<FoundStyles> found;
};

void add(const JudgedStyles& judged, Totals& totals) {
  const std::vector<PairError> pairs = judged.pair_errors();
  if (totals.pairs.empty()) {
    totals.pairs = pairs;
  } else {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      totals.pairs[i].add(pairs[i]);
    }
  }
  constexpr double kIntensities[] = {0.5, 1.0, 1.5};
  for (std::size_t i = 0; i < 3; ++i) {
    totals.lips.resize(3);
    totals.lips[i].intensity = kIntensities[i];
    totals.lips[i].add(judged.lips(kIntensities[i]));
  }
  constexpr Eigen::Index kFrames[] = {10, 30, 75};
  for (std::size_t i = 0; i < 3; ++i) {
    totals.found.resize(3);
    const FoundStyles found = judged.find_styles(kFrames[i]);
    totals.found[i].frames = found.frames;
    totals.found[i].right += found.right;
    totals.found[i].windows += found.windows;
  }
}

double percent(std::int64_t part, std::int64_t whole) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

void print(const Totals& totals) {
  fmt::print("\n| from | to | unchanged | mean difference | regression | style model |\n"
             "|---|---|---|---|---|---|\n");
  for (const PairError& pair : totals.pairs) {
    fmt::print("| {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n", pair.from, pair.to,
               pair.rms(&Squares::unchanged), pair.rms(&Squares::mean_difference),
               pair.rms(&Squares::regression), pair.rms(&Squares::ours));
  }
  fmt::print(
      "\n| intensity | /p b m/ closed before | after | /f v/ in range before | after | taken "
      "out | acceleration |\n|---|---|---|---|---|---|---|\n");
  for (const LipFigures& lips : totals.lips) {
    fmt::print("| {:.1f} | {} of {} | {} | {} of {} | {} | {} | {:.2f} |\n", lips.intensity,
               lips.closed_before, lips.lips, lips.closed_after, lips.inside_before, lips.teeth,
               lips.inside_after, lips.taken_out,
               *percentile(lips.changed, 0.99) / *percentile(lips.recorded, 0.99));
  }
  fmt::print("\n| frames | emotion found |\n|---|---|\n");
  for (const FoundStyles& found : totals.found) {
    fmt::print("| {} | {:.1f} % of {} |\n", found.frames, percent(found.right, found.windows),
               found.windows);
  }
}

void run(int folds, const StyleOptions& options) {
  const auto shared = shared_data();
  if (!shared) {
    fmt::print(stderr, "needs the recordings in ../shared/data, which are not here\n");
    std::exit(1);
  }
  const std::filesystem::path folder = *shared / "grid_s1_expressive";
  const Corpus corpus = read_corpus(folder);
  const std::vector<int> fold_of = assign_folds(corpus, 5, 1);
  Totals totals;
  for (int fold = 1; fold <= folds; ++fold) {
    std::set<std::string> held_out;
    for (std::size_t i = 0; i < fold_of.size(); ++i) {
      if (fold_of[i] == fold) {
        held_out.insert(corpus.sentences[i].id);
      }
    }
    const JudgedStyles judged = JudgedStyles::train(
        folder, [](const CorpusSentence&) { return true; },
        [&](const CorpusSentence& sentence) { return held_out.contains(sentence.id); }, options);
    const StyleModel& model = judged.trained.model;
    fmt::print("fold {}: {} sentences held out; J {}, ridge {:.3g} mm^2; unknown emotions I {}, "
               "J {}\n",
               fold, judged.spoken.size(), model.known.content_size(), model.ridge,
               model.unknown.style_size(), model.unknown.content_size());
    std::fflush(stdout);
    add(judged, totals);
  }
  print(totals);
}

} // namespace

// phonomime_style_table [FOLDS [channels|coefficients [BUNDLE]]]: how many of the five folds are
// judged (5), of what the vectors are (channels), how many frames a bundle has (3).
int main(int count, char** words) {
  try {
    StyleOptions options;
    if (count > 2 && std::string(words[2]) == "coefficients") {
      options.vectors = StyleVectors::coefficients;
    }
    if (count > 3) {
      options.bundle = std::atoi(words[3]);
    }
    run(count > 1 ? std::atoi(words[1]) : 5, options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
