// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/tune.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/json_file.h"
#include "db/types/sentence_key.h"
#include "db/types/text.h"
#include "tools/app/fingerprint.h"
#include "tools/app/sha256.h"
#include "tools/app/synth_inputs.h"
#include "tools/app/tune_sets.h"
#include "tools/app/workers.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

using Clock = std::chrono::steady_clock;

// All files of a corpus that an import reads, and where sentences are cut out of them.
std::string fingerprint(const Corpus& corpus) {
  FileFingerprints files;
  Sha256 digest;
  const auto description = corpus.folder / "corpus.json";
  digest.add(files.of(description));
  // Whatever file the description names: layout, sentence table, phoneme set.
  for (const auto& value : parse_json(read_file(description), description.string())) {
    const auto path = corpus.folder / (value.is_string() ? value.get<std::string>() : "");
    if (std::filesystem::is_regular_file(path)) {
      digest.add(files.of(path));
    }
  }
  for (const CorpusSentence& sentence : corpus.sentences) {
    digest.add(files.of(sentence.motion) + files.of(sentence.alignment));
  }
  return digest.hex();
}

bool several_emotions(const Corpus& corpus) {
  return std::ranges::any_of(corpus.sentences, [&](const CorpusSentence& sentence) {
    return sentence.emotion != corpus.sentences.front().emotion;
  });
}

class Run {
public:
  Run(const TuneOptions& options, const Progress& progress)
      : options_(options), progress_(progress), only_stop_{.report = {}, .stop = progress.stop},
        corpus_(read_corpus(options.import.corpus)),
        method_{.cost = options.synth.cost.value_or(kUsualCost),
                .blend = options.synth.blend.value_or(kUsualBlend),
                .concat = concat_options(options.synth),
                .objective = tune_objective(options.objective)},
        space_(method_.cost, options.only, several_emotions(corpus_)),
        plans_(plan_tune_sets(corpus_, {.folds = options.folds,
                                        .inner = options.inner,
                                        .sentences = options.sentences,
                                        .held_out = options.held_out,
                                        .seed = options.seed})),
        journal_(options.journal, described(true)) {
    tuning_.corpus = corpus_.name;
    tuning_.options = described(false);
    tuning_.objective = method_.objective;
    tuning_.weights.assign(space_.weights().begin(), space_.weights().end());
    if (options.only.empty() && !several_emotions(corpus_)) {
      tuning_.notes.emplace_back(
          "alpha6 stays as it is: all recordings are of one emotion, so that it changes nothing.");
    }
  }

  void prepare() {
    ImportOptions import = options_.import;
    import.recordings.threads = options_.synth.threads;
    for (const TuneSetPlan& plan : plans_) {
      const auto number = static_cast<std::int64_t>(sets_.size());
      progress_.update("preparing", number, static_cast<std::int64_t>(plans_.size()));
      sets_.push_back(std::make_unique<TuneSet>(plan, import, method_, only_stop_));
      add_notes(sets_.back()->notes());
    }
    tuning_.kind = sets_.front()->kind();
    tuning_.shipped = sets_.front()->shipped();
  }

  // Tunes to each inner set.
  void search() {
    const std::size_t count = inner_count();
    const CostWeights& shipped = tuning_.shipped;
    std::vector<Objective> objectives;
    for (std::size_t set = 0; set < count; ++set) {
      objectives.push_back([this, set](std::span<const double> point) {
        return objective(set, space_.at(point, tuning_.shipped));
      });
    }
    const int descent_looks = options_.descents * options_.evaluations;
    begin("tuning", count * static_cast<std::size_t>(1 + options_.starts + descent_looks));
    const auto limit = std::chrono::duration<double, std::ratio<60>>(options_.time_limit_min);
    if (options_.time_limit_min > 0.0) {
      deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(limit);
    }
    first_point_ = space_.point(shipped);
    const std::vector<Search> searches = search_from_many_starts(
        objectives, first_point_,
        {.starts = options_.starts,
         .descents = options_.descents,
         .evaluations = options_.evaluations,
         .seed = options_.seed},
        [this](std::size_t number, const std::function<void(std::size_t)>& body) {
          share_out_work(number, body);
        });
    deadline_.reset();
    for (std::size_t set = 0; set < count; ++set) {
      TunedPart part = tuned_part(set, searches[set]);
      (part.fold > 0 ? tuning_.folds.emplace_back() : tuning_.all) = std::move(part);
    }
    tuning_.out_of_time = out_of_time_;
  }

  // Speaks each outer fold with the shipped weights and with those tuned without it.
  void hold_out_folds() {
    const std::size_t first = inner_count();
    std::vector<SentenceValues> values(2 * tuning_.folds.size());
    begin("speaking held-out sentences", values.size());
    std::vector<std::exception_ptr> failures(values.size());
    share_out_work(values.size(), [&](std::size_t i) {
      try {
        const CostWeights& weights = i % 2 == 0 ? tuning_.shipped : tuning_.folds[i / 2].tuned;
        values[i] = evaluate(first + i / 2, weights);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    });
    for (const std::exception_ptr& failure : failures) {
      if (failure) {
        std::rethrow_exception(failure);
      }
    }
    for (std::size_t fold = 0; fold < tuning_.folds.size(); ++fold) {
      tuning_.folds[fold].held_out = {.keys = sets_[first + fold]->keys(),
                                      .shipped = values[2 * fold],
                                      .tuned = values[2 * fold + 1]};
    }
  }

  TuneReport finish() { return {.tuning = std::move(tuning_), .found = journal_.found()}; }

private:
  // What shapes the result. `of_values`: only what shapes the value of weights over a set.
  std::map<std::string, std::string> described(bool of_values) const {
    const ImportOptions& import = options_.import;
    const SynthOptions& synth = options_.synth;
    std::map<std::string, std::string> run;
    const auto add = [&](const char* name, const auto& value) {
      run[name] = fmt::format("{}", value);
    };
    add("objective", info(method_.objective).id);
    add("cost", kCostModelNames.at(static_cast<std::size_t>(method_.cost)));
    add("blend", method_.blend);
    add("folds", options_.folds);
    add("inner folds", options_.inner);
    add("sentences", options_.sentences);
    add("held-out sentences", options_.held_out > 0 ? std::to_string(options_.held_out) : "all");
    add("seed", options_.seed);
    add("smoothing", synth.smoothing_half_window);
    add("silence", kSilenceFillNames[static_cast<std::size_t>(synth.silence.fill)]);
    add("rest", synth.silence.rest_at_ends ? "yes" : "no");
    add("dimensions", import.pca.dimensions);
    if (of_values) {
      add("version", std::string_view("phonomime " PHONOMIME_VERSION));
      add("recordings", fingerprint(corpus_));
      add("scale", import.recordings.scale
                       ? std::to_string(static_cast<int>(*import.recordings.scale))
                       : "as found");
      add("faulty sentences", import.recordings.skip_faulty ? "left out" : "refused");
      return run;
    }
    add("starts", options_.starts);
    add("descents", options_.descents);
    add("evaluations of a descent", options_.evaluations);
    if (options_.time_limit_min > 0.0) {
      add("time limit in minutes", format_number(options_.time_limit_min));
    }
    return run;
  }

  std::size_t inner_count() const {
    return static_cast<std::size_t>(std::ranges::count_if(plans_, &TuneSetPlan::inner));
  }

  void add_notes(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) {
      if (std::ranges::find(tuning_.notes, note) == tuning_.notes.end()) {
        tuning_.notes.push_back(note);
      }
    }
  }

  // The values of a set's sentences, from the journal where it has them.
  SentenceValues evaluate(std::size_t set, const CostWeights& weights) {
    const std::string line = weights_line(weights);
    std::optional<SentenceValues> values = journal_.find(plans_[set].name, line);
    if (!values) {
      values = sets_[set]->speak(weights, only_stop_);
      journal_.add(plans_[set].name, line, *values);
    }
    const std::scoped_lock lock(mutex_);
    ++done_;
    if (progress_.report) {
      progress_.report(stage_, std::min(done_, total_), total_);
    }
    return *values;
  }

  std::optional<double> objective(std::size_t set, const CostWeights& weights) {
    const std::string line = weights_line(weights);
    const bool begins = line == weights_line(space_.at(first_point_, tuning_.shipped));
    if (deadline_ && Clock::now() >= *deadline_ && !begins &&
        !journal_.find(plans_[set].name, line)) {
      out_of_time_ = true;
      return std::nullopt;
    }
    return objective_value(set, evaluate(set, weights));
  }

  // The mean of what is bad.
  double objective_value(std::size_t set, SentenceValues values) const {
    for (std::optional<double>& value : values) {
      value = value ? badness(method_.objective, *value) : std::nullopt;
    }
    const std::optional<double> mean = mean_of(values);
    if (!mean) {
      throw InputError({.where = options_.import.corpus.string(),
                        .what = fmt::format("no sentence of set {} has a value of {}",
                                            quoted(plans_[set].name), info(method_.objective).id),
                        .remedy = "Tune to another objective, or speak more sentences."});
    }
    return *mean;
  }

  TunedPart tuned_part(std::size_t set, const Search& search) {
    const CostWeights& shipped = tuning_.shipped;
    TunedPart part{.fold = plans_[set].fold};
    const SentenceValues shipped_values = evaluate(set, shipped);
    part.looks.push_back({.weights = shipped, .value = objective_value(set, shipped_values)});
    std::set<std::string> seen = {weights_line(shipped)};
    for (const Look& look : search.looks) {
      const CostWeights weights = space_.at(look.point, shipped);
      if (seen.insert(weights_line(weights)).second) {
        part.looks.push_back({.weights = weights, .value = look.value});
      }
    }
    part.tuned = std::ranges::min_element(part.looks, {}, &EvaluatedWeights::value)->weights;
    part.inner = {
        .keys = sets_[set]->keys(), .shipped = shipped_values, .tuned = evaluate(set, part.tuned)};
    return part;
  }

  void begin(std::string stage, std::size_t total) {
    stage_ = std::move(stage);
    done_ = 0;
    total_ = static_cast<std::int64_t>(total);
    progress_.update(stage_, 0, total_);
  }

  // `body` does not throw. Throws Interrupted.
  void share_out_work(std::size_t count, const std::function<void(std::size_t)>& body) {
    share_out(count, worker_count(options_.synth.threads), progress_.stop,
              [&](std::size_t, std::size_t i) { body(i); });
    if (progress_.stop_requested()) {
      throw Interrupted();
    }
  }

  const TuneOptions& options_;
  const Progress& progress_;
  Progress only_stop_;
  Corpus corpus_;
  TuneMethod method_;
  WeightSpace space_;
  std::vector<TuneSetPlan> plans_;
  Journal journal_;
  std::vector<std::unique_ptr<TuneSet>> sets_; // #plans
  Tuning tuning_;
  std::vector<double> first_point_; // the shipped weights', or as near as ranges let it be
  std::optional<Clock::time_point> deadline_;
  std::atomic<bool> out_of_time_ = false;
  std::mutex mutex_; // of what follows
  std::string stage_;
  std::int64_t done_ = 0, total_ = 0;
};

void write_outputs(const TuneOptions& options, const Tuning& tuning) {
  OutputFiles files;
  files.stage(options.output, tuned_weights_file(tuning));
  for (const std::filesystem::path& path : options.reports) {
    const std::string kind = to_lower(path.extension().string());
    files.stage(path, kind == ".html"   ? tuning_html(tuning)
                      : kind == ".json" ? tuning_json(tuning)
                                        : tuning_text(tuning));
  }
  files.commit();
}

} // namespace

TuneReport run_tune(const TuneOptions& options, const Progress& progress) {
  options.validate();
  Run run(options, progress);
  run.prepare();
  run.search();
  run.hold_out_folds();
  TuneReport report = run.finish();
  write_outputs(options, report.tuning);
  return report;
}

} // namespace phonomime
