// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/evaluate.h"

#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/sentence_key.h"
#include "db/types/text.h"
#include "tools/app/evaluate_emotions.h"
#include "tools/app/evaluate_sizes.h"
#include "tools/app/folds.h"
#include "tools/app/held_out.h"
#include "tools/app/option_checks.h"
#include "tools/app/speak_held_out.h"
#include "tools/app/temporary_folder.h"
#include "tools/evaluate/method.h"
#include "tools/evaluate/report.h"
#include "tools/evaluate/showcase.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

constexpr int kMostFolds = 100;
constexpr int kWorstShown = 6;
constexpr int kSampleShown = 4;
constexpr std::array<std::string_view, 4> kOutputKinds = {".html", ".json", ".csv", ".txt"};

// The same progress, with a part of the whole named before each stage.
Progress within(const Progress& progress, std::string part) {
  if (!progress.report || part.empty()) {
    return progress;
  }
  return {.report =
              [report = progress.report, part = std::move(part)](
                  std::string_view stage, std::int64_t done, std::int64_t total) {
                report(fmt::format("{}: {}", part, stage), done, total);
              },
          .stop = progress.stop};
}

// Gathers what an evaluation is made of, fold by fold.
class Run {
public:
  Run(const EvaluateOptions& options, const Progress& progress)
      : options_(options), progress_(progress), corpus_(read_corpus(options.import.corpus)),
        methods_(find_methods(options.methods)),
        showcase_(std::string(methods_.front().name), kWorstShown, kSampleShown),
        sizes_(methods_.front(), options.seed), emotions_(methods_.front()),
        import_(options.import) {
    import_.recordings.threads = options.synth.threads;
    evaluation_.run.corpus = corpus_.name;
    evaluation_.run.seed = options.seed;
    evaluation_.layout = corpus_.layout;
    evaluation_.main_method = methods_.front().name;
    for (const MethodEntry& method : methods_) {
      evaluation_.methods.push_back({.id = std::string(method.name),
                                     .description = std::string(method.meaning),
                                     .sees_recording = method.sees_recording});
    }
    describe_options();
  }

  // Sentences that the database does not hold.
  void evaluate_database() {
    const std::filesystem::path& path = options_.synth.database;
    std::set<std::string> held;
    {
      const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
      for (const std::string& speaker : database.speakers()) {
        for (const SentenceInfo& sentence : database.load_motion_table(speaker).sentences) {
          held.insert(sentence_key(sentence));
        }
      }
    }
    std::vector<int> fold_of;
    for (const CorpusSentence& sentence : corpus_.sentences) {
      fold_of.push_back(held.contains(sentence_key(sentence)) ? -1 : 0);
    }
    const std::set<std::string> spoken = choose_spoken(fold_of, 0);
    if (spoken.empty()) {
      throw InputError({.where = options_.import.corpus.string(),
                        .what = "the database holds every sentence of the corpus",
                        .expected = "recordings that it has not seen",
                        .remedy = "Evaluate with --folds instead, or with another corpus."});
    }
    Corpus corpus = corpus_;
    keep_sentences(corpus, [&](const CorpusSentence& sentence) {
      return spoken.contains(sentence_key(sentence));
    });
    evaluation_.run.held_out_by = "sentences that the database does not hold";
    add(read_held_out(path, corpus, import_.recordings, progress_), 0);
  }

  void evaluate_folds() {
    const std::vector<int> fold_of = assign_folds(corpus_, options_.folds, options_.seed);
    const std::set<std::string> spoken = choose_spoken(fold_of, options_.fold);
    evaluation_.run.folds = options_.folds;
    evaluation_.run.held_out_by =
        options_.fold > 0 ? fmt::format("fold {} of {} by sentence", options_.fold, options_.folds)
                          : fmt::format("{} folds by sentence", options_.folds);
    for (int fold = 1; fold <= options_.folds; ++fold) {
      std::set<std::string> held_out;
      for (std::size_t i = 0; i < corpus_.sentences.size(); ++i) {
        if (fold_of[i] == fold) {
          held_out.insert(sentence_key(corpus_.sentences[i]));
        }
      }
      if (std::ranges::none_of(held_out,
                               [&](const std::string& key) { return spoken.contains(key); })) {
        continue;
      }
      const TemporaryFolder folder;
      const Progress progress =
          within(progress_, fmt::format("fold {} of {}", fold, options_.folds));
      add(hold_out(
              import_,
              [&](const CorpusSentence& sentence) {
                return held_out.contains(sentence_key(sentence));
              },
              [&](const CorpusSentence& sentence) {
                return spoken.contains(sentence_key(sentence));
              },
              folder.path() / "fold.db", progress),
          fold);
    }
  }

  EvaluateReport finish() {
    evaluation_.sizes = sizes_.points();
    if (options_.emotions) {
      evaluation_.emotions = emotions_.findings();
    }
    evaluation_.run.left_out =
        static_cast<std::int64_t>(corpus_.sentences.size()) -
        static_cast<std::int64_t>(evaluation_.methods.front().sentences.size());
    aggregate(evaluation_);
    return {.evaluation = std::move(evaluation_), .comparison = std::nullopt};
  }

  std::vector<ShownSentence> shown() const { return showcase_.shown(); }

private:
  void describe_options() {
    std::map<std::string, std::string>& options = evaluation_.run.options;
    const SynthOptions& synth = options_.synth;
    options["weights"] = synth.weights.empty() ? "default" : trim_spaces(read_file(synth.weights));
    options["blend"] = fmt::format("{}", synth.blend.value_or(kUsualBlend));
    options["smoothing"] = fmt::format("{}", synth.smoothing_half_window);
    options["silence"] = kSilenceFillNames[static_cast<std::size_t>(synth.silence.fill)];
    options["rest"] = synth.silence.rest_at_ends ? "yes" : "no";
    if (synth.database.empty()) {
      options["dimensions"] = fmt::format("{}", options_.import.pca.dimensions);
    }
    if (options_.sentences > 0) {
      options["sentences"] = fmt::format("{}", options_.sentences);
    }
  }

  // A file's text on one line.
  static std::string trim_spaces(std::string_view text) {
    std::vector<std::string_view> words;
    for (const std::string_view line : split_lines(text)) {
      for (const std::string_view word : split_words(line)) {
        words.push_back(word);
      }
    }
    return fmt::format("{}", fmt::join(words, " "));
  }

  // Keys of the sentences of a fold (0: of all, negative ones are not evaluated), as many as are
  // asked for, by lot.
  std::set<std::string> choose_spoken(const std::vector<int>& fold_of, int fold) const {
    std::set<std::string> spoken;
    for (const std::size_t i : in_order_of_lots(corpus_.sentences, options_.seed)) {
      const bool wanted = fold == 0 ? fold_of[i] >= 0 : fold_of[i] == fold;
      const bool full =
          options_.sentences > 0 && spoken.size() >= static_cast<std::size_t>(options_.sentences);
      if (wanted && !full) {
        spoken.insert(sentence_key(corpus_.sentences[i]));
      }
    }
    return spoken;
  }

  void add(const HeldOut& held_out, int fold) {
    const Progress progress = within(
        progress_, fold > 0 ? fmt::format("fold {} of {}", fold, options_.folds) : std::string());
    evaluation_.run.rate_hz = held_out.tables.begin()->second.rate_hz;
    evaluation_.run.notes.insert(evaluation_.run.notes.end(), held_out.notes.begin(),
                                 held_out.notes.end());
    if (options_.emotions) {
      emotions_.add(held_out, options_.synth, within(progress, "emotions"));
    }
    speak_held_out(held_out.tables, held_out.sentences, methods_, options_.synth, progress,
                   [&](std::size_t i, SpokenSentence&& spoken) {
                     offer(held_out, held_out.sentences[i], std::move(spoken), fold);
                   });
    if (options_.sizes) {
      sizes_.add(held_out, options_.synth, within(progress, "sizes"));
    }
  }

  void offer(const HeldOut& held_out, const ImportedSentence& recorded, SpokenSentence&& spoken,
             int fold) {
    const MotionTable& table = held_out.tables.at(recorded.speaker);
    const MeasureSetup setup{
        .layout = table.layout, .rate_hz = table.rate_hz, .reference_pose = table.reference_pose};
    const std::optional<double> error =
        measure_values(spoken.measures.front().sums)[Measure::squared_error];
    showcase_.offer(setup, recorded, spoken.synthesised, error);
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      MethodResult& result = evaluation_.methods[m];
      result.sentences.push_back(std::move(spoken.measures[m]));
      if (fold > 0) {
        result.folds.push_back(fold);
      }
    }
  }

  const EvaluateOptions& options_;
  const Progress& progress_;
  Corpus corpus_;
  std::vector<MethodEntry> methods_;
  Showcase showcase_;
  SizeStudy sizes_;
  EmotionStudy emotions_;
  ImportOptions import_;
  Evaluation evaluation_;
};

void write_outputs(const EvaluateOptions& options, const EvaluateReport& report,
                   const std::vector<ShownSentence>& shown) {
  OutputFiles files;
  for (const std::filesystem::path& path : options.synth.outputs) {
    const std::string kind = to_lower(path.extension().string());
    if (kind == ".html") {
      files.stage(path, evaluation_html(report.evaluation, shown, report.comparison));
    } else if (kind == ".json") {
      files.stage(path, evaluation_json(report.evaluation, report.comparison).dump(1) + "\n");
    } else if (kind == ".csv") {
      files.stage(path, sentences_csv(report.evaluation));
    } else {
      files.stage(path, evaluation_text(report.evaluation, report.comparison));
    }
  }
  files.commit();
}

void check_outputs(const std::vector<std::filesystem::path>& outputs) {
  for (const std::filesystem::path& path : outputs) {
    if (std::ranges::find(kOutputKinds, to_lower(path.extension().string())) ==
        kOutputKinds.end()) {
      throw UsageError({.where = path.string(),
                        .what = "the output's suffix does not say what it is to be",
                        .expected = fmt::format("one of {}", fmt::join(kOutputKinds, ", "))});
    }
  }
  check_outputs_differ(outputs);
}

} // namespace

void EvaluateOptions::validate() const {
  import.validate();
  if (synth.database.empty() && folds == 0) {
    throw UsageError({.what = "nothing says which recordings are to speak",
                      .remedy = "Name a database with --db, or hold parts of the corpus out with "
                                "--folds."});
  }
  if (!synth.database.empty() && folds != 0) {
    throw UsageError({.what = "--db and --folds do not go together"});
  }
  if (folds != 0) {
    check_range("--folds", folds, 2, kMostFolds);
    check_range("--fold", fold, 0, folds);
  } else if (fold != 0) {
    throw UsageError({.where = "--fold", .what = "needs --folds"});
  }
  check_range("--sentences", sentences, 0, std::numeric_limits<int>::max());
  check_motion_options(synth);
  check_outputs(synth.outputs);
  find_methods(methods);
}

EvaluateReport run_evaluate(const EvaluateOptions& options, const Progress& progress) {
  options.validate();
  std::optional<EarlierRun> earlier;
  if (!options.against.empty()) {
    earlier = parse_evaluation(read_file(options.against), options.against.string());
  }
  Run run(options, progress);
  if (options.folds > 0) {
    run.evaluate_folds();
  } else {
    run.evaluate_database();
  }
  EvaluateReport report = run.finish();
  if (earlier) {
    report.comparison = compare_runs(report.evaluation, *earlier);
  }
  write_outputs(options, report, run.shown());
  return report;
}

} // namespace phonomime
