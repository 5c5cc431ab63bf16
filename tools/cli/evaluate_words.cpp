// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/call_words.h"

#include <CLI/CLI.hpp>

namespace phonomime {

namespace {

// How a corpus is read, for verbs that hold parts of it out.
void add_reading(CLI::App* verb, ImportOptions& options, CallWords& words) {
  verb->add_option("--dimensions", options.pca.dimensions,
                   "PCA dimensions that frames are reduced to, where a part is held out")
      ->type_name("N")
      ->capture_default_str();
  add_scale(verb, words);
  verb->add_flag("--skip-faulty", options.recordings.skip_faulty,
                 "Leave out sentences whose files are faulty instead of refusing the corpus");
}

} // namespace

void add_evaluate(CLI::App& app, CallWords& words) {
  EvaluateOptions& options = words.evaluate.options;
  CLI::App* verb = app.add_subcommand("evaluate", "How near to recordings syntheses of them come");
  verb->footer("Example:\n  phonomime evaluate recordings/ann --folds 5 -o ann.html -o ann.json\n"
               "  phonomime evaluate recordings/new --db ann.db --methods paper,oracle\n\n"
               "Each held-out sentence is spoken by every method from its transcript and\n"
               "compared with its recording. docs/evaluation.md explains methods and measures.");
  verb->add_option("corpus", options.import.corpus, "The folder with corpus.json")
      ->required()
      ->type_name("CORPUS");
  CLI::Option* database =
      verb->add_option("--db", options.synth.database,
                       "Speak with this database the sentences of CORPUS that it does not hold")
          ->type_name("DB");
  CLI::Option* folds =
      verb->add_option("--folds", options.folds,
                       "Instead: hold each of N parts of CORPUS out in turn and speak it with the "
                       "others, 2 to 100")
          ->type_name("N")
          ->excludes(database);
  verb->add_option("--fold", options.fold, "Only this part, from 1")->type_name("K")->needs(folds);
  verb->add_option("--seed", options.seed, "Of the lots by which sentences are drawn")
      ->type_name("SEED")
      ->capture_default_str();
  verb->add_option("--sentences", options.sentences,
                   "At most so many sentences, by lot (default: all)")
      ->type_name("N");
  verb->add_option("--methods", options.methods, "Which methods, the main one first (default: all)")
      ->type_name("NAME,...")
      ->delimiter(',');
  verb->add_flag("--sizes", options.sizes,
                 "Also: the main method with growing parts of the recordings");
  verb->add_flag("--emotions", options.emotions,
                 "Also: how often the emotion that was asked for is recognised in the motion");
  verb->add_option("--against", options.against,
                   "JSON report of an earlier run: what has become better or worse")
      ->type_name("FILE");
  verb->add_option("-o,--output", options.synth.outputs,
                   "Reports; the suffix says what: .html (all of it, for a browser), .json (all "
                   "figures), .csv (a line for each sentence), .txt (as printed)")
      ->type_name("FILE...");
  add_weights(verb, options.synth);
  add_blend(verb, options.synth);
  add_joins(verb, options.synth, words);
  add_reading(verb, options.import, words);
  add_threads(verb, options.synth);
}

void add_tune(CLI::App& app, CallWords& words) {
  TuneOptions& options = words.tune.options;
  CLI::App* verb = app.add_subcommand("tune", "Cost weights that come nearest to recordings");
  verb->footer(
      "Example:\n  phonomime tune recordings/ann -o weights.json --journal ann.journal \\\n"
      "      --report ann_tune.html\n\n"
      "Weights are tuned to all of the corpus, and without each fold, which then says\n"
      "what such a tuning is worth. docs/tune.md explains the search and the folds.");
  verb->add_option("corpus", options.import.corpus, "The folder with corpus.json")
      ->required()
      ->type_name("CORPUS");
  verb->add_option("-o,--output", options.output, "The weights file, for --weights")
      ->required()
      ->type_name("FILE");
  verb->add_option(
          "--report", options.reports,
          "Reports; the suffix says what: .html (for a browser), .json (all figures), .txt "
          "(as printed)")
      ->type_name("FILE...");
  verb->add_option("--journal", options.journal,
                   "Keep every evaluation in this file; a call that was stopped goes on from it")
      ->type_name("FILE");
  verb->add_option(
          "--objective", options.objective,
          "What is made better: e13 (squared error) or another measure of evaluate, such as "
          "lip_rmse")
      ->type_name("MEASURE")
      ->capture_default_str();
  verb->add_option(
          "--only", options.only,
          "Tune these weights alone, as they are named in a weights file (default: all that "
          "make a difference)")
      ->type_name("NAME,...")
      ->delimiter(',');
  const auto add = [&](const char* name, auto& value, const char* type, const char* meaning) {
    verb->add_option(name, value, meaning)->type_name(type)->capture_default_str();
  };
  add("--folds", options.folds, "N", "Parts of CORPUS that are held out in turn, 2 to 100");
  add("--inner", options.inner, "N", "Parts in which each tuning holds out in turn, 2 to 100");
  add("--sentences", options.sentences, "N", "Sentences spoken in each evaluation, by lot");
  verb->add_option("--held-out", options.held_out,
                   "At most so many sentences of each part held out are spoken (default: all)")
      ->type_name("N");
  add("--starts", options.starts, "N", "Points drawn where the search begins");
  add("--descents", options.descents, "N", "The best of them that it goes down from");
  add("--evaluations", options.evaluations, "N", "At most so many in each descent");
  add("--seed", options.seed, "SEED", "Of the lots by which all is drawn");
  verb->add_option("--time-limit", options.time_limit_min,
                   "After so many minutes the search ends with what it has (default: none)")
      ->type_name("MINUTES");
  add_cost(verb, words);
  add_blend(verb, options.synth);
  add_joins(verb, options.synth, words);
  add_reading(verb, options.import, words);
  add_threads(verb, options.synth);
}

} // namespace phonomime
