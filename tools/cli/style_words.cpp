// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/call_words.h"

#include <string>

#include <CLI/CLI.hpp>

namespace phonomime {

namespace {

void add_style_train(CLI::App* style, StyleWords& words) {
  StyleOptions& options = words.train.options.style;
  CLI::App* verb = style->add_subcommand("train", "Learn a speaker's emotions, and store them");
  verb->footer("Example:\n  phonomime style train ann.db\n\n"
               "Needs sentences that the speaker recorded in several emotions. A pruning or an\n"
               "import makes the model stale: then train it anew.");
  add_database(verb, words.train.options.database, false);
  add_speaker(verb, words.train.options.speaker);
  verb->add_option("--emotion", options.training.styles,
                   "Only these emotions, the one that intensity 0 is among them (default: all "
                   "that have nodes)")
      ->type_name("NAME...");
  verb->add_option("--neutral", options.training.reference, "The emotion that intensity 0 is")
      ->type_name("NAME")
      ->capture_default_str();
  verb->add_option("--bundle", options.bundle, "Frames that are looked at together, odd")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--content", options.content_size,
                   "Dimensions of what is said, J (default: by cross-validation)")
      ->type_name("J");
  verb->add_option("--ridge", options.ridge,
                   "How strongly contents are drawn to their mean, a variance (default: by "
                   "cross-validation)")
      ->type_name("RIDGE");
  verb->add_flag("--coefficients", words.coefficients,
                 "Compare PCA coefficients instead of channels: the mean face then counts as a "
                 "movement");
  verb->add_option("--styles", options.style_size,
                   "Dimensions of the emotions where they have to be found, I (default: by "
                   "cross-validation)")
      ->type_name("I");
  verb->add_option("--unknown-content", options.unknown_content_size,
                   "Dimensions of what is said where the emotion has to be found (default: by "
                   "cross-validation)")
      ->type_name("J");
  verb->add_option("--parts", options.training.parts,
                   "Parts of the sentences that the cross-validation leaves out in turn")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--threads", options.threads,
                   "Threads to work with (default: one for each core)")
      ->type_name("N");
}

void add_style_show(CLI::App* style, StyleWords& words) {
  CLI::App* verb = style->add_subcommand("show", "What the stored model knows, and how well");
  verb->footer("Example:\n  phonomime style show ann.db");
  add_database(verb, words.show.database, false);
  add_speaker(verb, words.show.speaker);
}

void add_style_apply(CLI::App* style, StyleWords& words) {
  StyleApplyOptions& options = words.apply.options;
  CLI::App* verb = style->add_subcommand("apply", "A motion file in another emotion");
  verb->footer(
      "Example:\n  phonomime style apply ann.db take.c3d --from neutral --to happiness:0.6 \\\n"
      "      --transcript take.lab -o take.csv\n\n"
      "With the transcript the lips keep their contacts (/p b m/ close, /f v/ touch).\n"
      "Emotions mix as happiness:0.6+anger:0.3; docs/style.md says more.");
  add_database(verb, options.database, false);
  verb->add_option("motion", options.motion,
                   "Motion of the database's markers or weights: .csv (also Live Link Face), .c3d")
      ->required()
      ->type_name("MOTION");
  verb->add_option("-o,--output", options.outputs,
                   "Outputs; the suffix says what: .csv (marker or Live Link motion), .glb "
                   "(animated mesh), .html (player), .json (the report)")
      ->type_name("FILE...");
  verb->add_option("--from", options.from,
                   "The emotion that the motion shows; unknown: the model finds it")
      ->type_name("EMOTION")
      ->capture_default_str();
  verb->add_option("--to", options.to, "The emotion that it is to show")
      ->type_name("NAME[:INTENSITY][+...]");
  verb->add_option("--emotions", options.emotions,
                   "Emotion track: a text file of lines START END EMOTION; where it is silent, "
                   "--to, else the emotion stays")
      ->type_name("TRACK");
  verb->add_option("--transcript", options.transcript, "What is said: .lab or .TextGrid")
      ->type_name("TRANSCRIPT");
  verb->add_option("--phoneme-set", options.phoneme_set,
                   "The transcript's alphabet (default: the first that knows every symbol)")
      ->type_name("SET");
  verb->add_option("--tier", options.tier, "The phone tier of a TextGrid (default: found by name)")
      ->type_name("NAME");
  add_speaker(verb, options.speaker);
  verb->add_option(
          "--layout", options.reading.layout,
          "The layout.json of the corpus that the motion is from, where its axes are others "
          "than the database's")
      ->type_name("FILE");
  verb->add_option("--gap-limit", options.reading.gap_limit_s,
                   "Longest run of missing markers that is filled, in seconds")
      ->type_name("SECONDS")
      ->capture_default_str();
  verb->add_option("--fps", options.fps,
                   "Output frames a second, 1 to 1000 (default: the motion's own)")
      ->type_name("N");
  verb->add_flag("--head", options.head, "Put the head's motion back");
  verb->add_option("--face", options.face,
                   "Mesh (.obj, .glb) or the folder with it; needed for .glb and .html")
      ->type_name("FACE");
  verb->add_option("--audio", options.audio, "Sound for the player")->type_name("WAV");
}

} // namespace

void add_style(CLI::App& app, CallWords& words) {
  CLI::App* style = app.add_subcommand("style", "Emotions: less, more, mixed, of any motion");
  style->require_subcommand(1);
  style->footer("Example:\n  phonomime style train ann.db\n"
                "  phonomime synth --db ann.db hello.lab --emotion happiness:0.5 -o hello.csv\n\n"
                "`phonomime style VERB --help` says more of a verb; so does docs/style.md.");
  add_style_train(style, words.style);
  add_style_show(style, words.style);
  add_style_apply(style, words.style);
}

void take_style_words(const CLI::App& style, CallWords& words) {
  StyleWords& own = words.style;
  if (own.coefficients) {
    own.train.options.style.vectors = StyleVectors::coefficients;
  }
  const std::string verb = style.get_subcommands().front()->get_name();
  if (verb == "train") {
    words.arguments.verb = own.train;
  } else if (verb == "apply") {
    words.arguments.verb = own.apply;
  } else {
    words.arguments.verb = own.show;
  }
}

} // namespace phonomime
