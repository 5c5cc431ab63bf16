// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/call_words.h"

#include <CLI/CLI.hpp>

namespace phonomime {

namespace {

void add_synth_inputs(CLI::App* verb, SynthOptions& options, CallWords& words) {
  add_transcript_options(verb, words);
  add_blend(verb, options);
  verb->add_option("--audio", options.audio, "Sound for the player")->type_name("WAV");
  verb->add_option("--face", options.face,
                   "Mesh (.obj, .glb) or the folder with it; needed for .glb and .html")
      ->type_name("FACE");
}

// All that makes motion of a transcript, for every verb that does.
void add_synth_options(CLI::App* verb, CallWords& words) {
  SynthOptions& options = words.synth.options;
  add_synth_inputs(verb, options, words);
  CLI::Option* retime = verb->add_flag(
      "--retime", options.retime,
      "Give phonemes the tempo of their emotions, as recorded, and write the transcript with its "
      "new times beside the first output (.retimed.lab)");
  verb->add_flag("--retime-with-audio", options.retime_with_audio,
                 "With --retime: although there is --audio, which then no longer fits")
      ->needs(retime);
  verb->add_option("--fps", options.fps, "Output frames a second, 1 to 1000")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--head", words.head,
                   "A constant head pose, also put back into marker CSV, in degrees and mm "
                   "(default: the head rests)")
      ->type_name("YAW,PITCH,ROLL[,X,Y,Z]");
  add_joins(verb, options, words);
  verb->add_option("--runners-up", options.runners_up,
                   "Runners-up for each phoneme in .json and .txt, 0 to 100")
      ->type_name("N")
      ->capture_default_str();
  add_threads(verb, options);
}

} // namespace

void add_transcript_options(CLI::App* verb, CallWords& words) {
  SynthOptions& options = words.synth.options;
  add_speaker(verb, options.speaker);
  verb->add_option(
          "--emotion", options.emotion,
          "One emotion throughout, or a mixture as happiness:0.6+anger:0.3 (default: neutral)")
      ->type_name("NAME[:INTENSITY]");
  verb->add_option("--emotions", options.emotions,
                   "Emotion track: a text file of lines START END EMOTION [INTENSITY]")
      ->type_name("TRACK");
  verb->add_option("--constraints", options.constraints,
                   "Constraint file: which nodes to use or to avoid, and where")
      ->type_name("FILE");
  add_cost(verb, words);
  add_weights(verb, options);
  verb->add_option("--phoneme-set", options.phoneme_set,
                   "The transcript's alphabet: festival_us, arpabet, timit or a .json file "
                   "(default: the first that knows every symbol)")
      ->type_name("SET");
  verb->add_option("--tier", options.tier, "The phone tier of a TextGrid (default: found by name)")
      ->type_name("NAME");
}

void add_weights(CLI::App* verb, SynthOptions& options) {
  verb->add_option("--weights", options.weights, "Cost weights of the search (JSON)")
      ->type_name("FILE");
}

void add_blend(CLI::App* verb, SynthOptions& options) {
  verb->add_option("--blend", options.blend,
                   "Node-disjoint paths whose motion is blended, 1 to 100 (default: 8)")
      ->type_name("K");
}

void add_cost(CLI::App* verb, CallWords& words) {
  verb->add_option("--cost", words.cost,
                   "The search's cost: paper (Deng and Neumann's alone) or context (also how well "
                   "nodes fit what is said around them; default)")
      ->type_name("COST");
}

void add_joins(CLI::App* verb, SynthOptions& options, CallWords& words) {
  verb->add_option("--silence", words.silence, "How inner silence is filled: linear, cosine, cubic")
      ->type_name("FILL")
      ->capture_default_str();
  verb->add_flag("--no-rest", words.no_rest,
                 "Hold the first and the last pose through silence at the ends, instead of the "
                 "face at rest");
  verb->add_option("--smoothing", options.smoothing_half_window,
                   "Frames on either side of a join that are smoothed, 0 to 100")
      ->type_name("N")
      ->capture_default_str();
}

void add_threads(CLI::App* verb, SynthOptions& options) {
  verb->add_option("--threads", options.threads,
                   "Threads to work with (default: one for each core)")
      ->type_name("N");
}

void add_synth(CLI::App& app, CallWords& words) {
  CLI::App* verb = app.add_subcommand("synth", "A transcript in, a talking face out");
  verb->footer("Example:\n  phonomime synth --db ann.db hello.lab --emotions hello.emotions \\\n"
               "      --constraints hello.constraints --audio hello.wav --face head.glb \\\n"
               "      -o hello.html -o hello.glb -o hello.csv\n\n"
               "corpora_schema/ describes every file; corpora_schema/transcript.md also what a\n"
               "stream takes.");
  SynthOptions& options = words.synth.options;
  add_database(verb, options.database, true);
  CLI::Option* transcript =
      verb->add_option("transcript", options.transcript,
                       "Phonemes with times: .lab (Festival, HTK) or .TextGrid")
          ->required()
          ->type_name("TRANSCRIPT");
  verb->add_option(
          "-o,--output", options.outputs,
          "Outputs; the suffix says what: .csv (marker or Live Link motion), .glb (animated "
          "mesh), .html (player), .json (the result), .lab (the transcript), .txt (the "
          "explanation)")
      ->type_name("FILE...");
  add_synth_options(verb, words);
  CLI::Option* stream = verb->add_flag_callback(
      "--stream",
      [transcript, &words] {
        transcript->required(false);
        words.streams = true;
      },
      "Instead of TRANSCRIPT: read lines START END LABEL [EMOTION] from standard input as they "
      "come, and write frames as CSV to standard output as they become final");
  verb->add_option("--look-ahead", words.stream.look_ahead,
                   "With --stream: phonemes that are known beyond one before its motion is final, "
                   "0 to 1000")
      ->type_name("N")
      ->capture_default_str()
      ->needs(stream);
  verb->add_flag("--compare", words.stream.compare,
                 "With --stream: at the end, say how far from the optimum it was")
      ->needs(stream);
}

void add_batch(CLI::App& app, CallWords& words) {
  CLI::App* verb = app.add_subcommand("batch", "Many transcripts in, a face that says each out");
  verb->footer(
      "Example:\n  phonomime batch lines.tsv --db ann.db --face head.glb -o 'out/{id}.glb'\n\n"
      "Options hold for the rows whose own cell is empty. Rows that are done and\n"
      "unchanged are skipped. corpora_schema/manifest.md describes the manifest,\n"
      "docs/batch.md how to spread a batch over machines.");
  verb->add_option("manifest", words.batch.manifest,
                   "Table of transcripts and what to make of them, separated by tabs")
      ->required()
      ->type_name("MANIFEST");
  add_database(verb, words.synth.options.database, true);
  verb->add_option("-o,--output", words.synth.options.outputs,
                   "Outputs of every row whose cell names none; {id} stands for the row's id; the "
                   "suffix says what, as for synth")
      ->type_name("FILE...");
  add_synth_options(verb, words);
  verb->add_option("--shard", words.shard, "Only the Ith of N parts of the batch")
      ->type_name("I/N");
  verb->add_flag("--redo", words.batch.redo, "Rows that are done, too");
}

} // namespace phonomime
