// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/cli/arguments.h"

#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace phonomime {

// Of `phonomime map ...`.
struct MapWords {
  MapBuildArguments build;
  MapShowArguments show;
  MapImageArguments image;
  MapPickArguments pick;
  MapQualityArguments quality;
  std::string kind = "isomap", components = "join", size = "1000x800";
  std::vector<std::string> context, palette;
};

// Of `phonomime retarget ...`.
struct RetargetWords {
  RetargetListArguments list;
  RetargetApplyArguments apply;
  RetargetReferencesArguments references;
  ChooseKeyshapesArguments choose;
  ApplyRigArguments rig;
  std::string keyshape_method = "extrema";
};

// Of `phonomime style ...`.
struct StyleWords {
  StyleTrainArguments train;
  StyleShowArguments show;
  StyleApplyArguments apply;
  bool coefficients = false;
};

// Of verbs that list motion nodes, or take them out of use.
struct CurationWords {
  NodeFilter filter;
  bool only_suspect = false, only_pruned = false, only_gaps = false;
  bool csv = false, keys_alone = false;
  long limit = 0; // 0 = all
  SuspectsArguments suspects;
  CurateArguments curate;
  JournalArguments journal;
};

// What the words of the call are put into before a verb's struct is made of them.
struct CallWords {
  Arguments arguments;
  ImportArguments import;
  InfoArguments info;
  NodesArguments nodes;
  SynthArguments synth;
  StreamOptions stream; // but its synthesis
  BatchOptions batch;   // but its synthesis
  EvaluateArguments evaluate;
  TuneArguments tune;
  ExplainArguments explain;
  MapWords map;
  RetargetWords retarget;
  StyleWords style;
  RecommendArguments recommend; // but its synthesis
  CurationWords curation;
  std::string scale, cost, head, silence = "linear", shard = "1/1";
  bool no_rest = false, streams = false;
};

// Each adds a verb, or options of one, to what the program understands.

// DB as an option --db or as a word of its own.
void add_database(CLI::App* verb, std::filesystem::path& database, bool option);

void add_speaker(CLI::App* verb, std::string& speaker);

void add_scale(CLI::App* verb, CallWords& words);

// What a transcript is to be spoken like.
void add_transcript_options(CLI::App* verb, CallWords& words);

// How the search weighs nodes, how many paths are blended.
void add_cost(CLI::App* verb, CallWords& words);
void add_weights(CLI::App* verb, SynthOptions& options);
void add_blend(CLI::App* verb, SynthOptions& options);

// How nodes become motion, for every verb that makes any.
void add_joins(CLI::App* verb, SynthOptions& options, CallWords& words);

void add_threads(CLI::App* verb, SynthOptions& options);

void add_nodes(CLI::App& app, CallWords& words);
// suspects, prune, restore, undo, journal
void add_curation(CLI::App& app, CallWords& words);
// Whether the call's verb is one of these or `nodes`: then its words are taken.
bool take_curation_words(const CLI::App& verb, CallWords& words);

void add_synth(CLI::App& app, CallWords& words);
void add_batch(CLI::App& app, CallWords& words);
void add_evaluate(CLI::App& app, CallWords& words);
void add_tune(CLI::App& app, CallWords& words);

void add_map(CLI::App& app, CallWords& words);
void add_recommend(CLI::App& app, CallWords& words);
// Which of the verbs of `map` it is.
void take_map_words(const CLI::App& map, CallWords& words);

void add_retarget(CLI::App& app, CallWords& words);
// Which of the verbs of `retarget` it is.
void take_retarget_words(const CLI::App& retarget, CallWords& words);

// The verbs of `retarget keyshapes`, and which of them it is.
void add_keyshapes(CLI::App& retarget, RetargetWords& words);
void take_keyshapes_words(const CLI::App& keyshapes, CallWords& words);

// How weights are solved for, and in which expression a rig moves.
void add_weight_choices(CLI::App* verb, WeightChoices& weights, double& filter_s);
void add_expression(CLI::App* verb, RigChoice& choice);

void add_style(CLI::App& app, CallWords& words);
// Which of the verbs of `style` it is.
void take_style_words(const CLI::App& style, CallWords& words);

} // namespace phonomime
