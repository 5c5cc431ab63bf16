// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/arguments.h"

#include "db/types/errors.h"
#include "tools/cli/help.h"
#include "tools/cli/words.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

// What the words of the call are put into before a verb's struct is made of them.
struct Words {
  Arguments arguments;
  ImportArguments import;
  InfoArguments info;
  NodesArguments nodes;
  SynthArguments synth;
  StreamOptions stream; // but its synthesis
  BatchOptions batch;   // but its synthesis
  ExplainArguments explain;
  bool only_suspect = false, only_pruned = false, only_gaps = false;
  std::string head, silence = "linear", shard = "1/1";
  bool no_rest = false, streams = false;
};

// A call's help as a page: CLI11's own shows its inner workings.
class HelpFormatter : public CLI::FormatterBase {
public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const override {
    HelpPage page{.title = app->get_description(), .usage = std::move(name)};
    HelpSection verbs{.heading = "Verbs"}, words{.heading = "Arguments"}, options{"Options", {}};
    for (const CLI::App* verb : app->get_subcommands({})) {
      verbs.entries.push_back({verb->get_name(), verb->get_description()});
    }
    for (const CLI::Option* option : app->get_options()) {
      HelpSection& section = option->get_positional() ? words : options;
      section.entries.push_back({term(*option), meaning(*option)});
      if (option->get_required()) {
        page.usage += " " + (option->get_positional() ? "" : option->get_name() + " ") +
                      option->get_type_name();
      }
    }
    page.usage += verbs.entries.empty() ? " [OPTIONS]" : " VERB ...";
    std::ranges::rotate(options.entries, options.entries.begin() + 1); // --help comes last
    page.sections = {std::move(verbs), std::move(words), std::move(options)};
    page.footer = app->get_footer();
    return format_help(page);
  }

private:
  static std::string term(const CLI::Option& option) {
    if (option.get_positional()) {
      return option.get_type_name();
    }
    std::string text;
    for (const std::string& name : option.get_snames()) {
      text += fmt::format("-{}, ", name);
    }
    text += fmt::format("--{}", fmt::join(option.get_lnames(), ", --"));
    return option.get_items_expected_max() > 0 ? text + " " + option.get_type_name() : text;
  }

  static std::string meaning(const CLI::Option& option) {
    std::vector<std::string> notes;
    if (!option.get_default_str().empty()) {
      notes.push_back("default: " + option.get_default_str());
    }
    for (const CLI::Option* other : option.get_excludes()) {
      notes.push_back("not with " + other->get_name());
    }
    if (option.get_required() && !option.get_positional()) {
      notes.emplace_back("required");
    }
    return option.get_description() +
           (notes.empty() ? "" : fmt::format(" ({})", fmt::join(notes, "; ")));
  }
};

void add_database(CLI::App* verb, std::filesystem::path& database, bool option) {
  auto* added = option ? verb->add_option("--db", database, "The motion database")
                       : verb->add_option("database", database, "The motion database");
  added->required()->type_name("DB");
}

void add_import(CLI::App& app, Words& words) {
  ImportOptions& options = words.import.options;
  CLI::App* verb = app.add_subcommand("import", "Put a corpus folder into a motion database");
  verb->footer("Example:\n  phonomime import recordings/ann --db ann.db\n\n"
               "The database is made where it does not exist, else added to; an import that\n"
               "fails or is stopped changes nothing. corpora_schema/corpus.md describes the\n"
               "folder.");
  verb->add_option("corpus", options.corpus, "The folder with corpus.json")
      ->required()
      ->type_name("CORPUS");
  add_database(verb, options.database, true);
  verb->add_option("--rate", options.rate_hz,
                   "Frames a second of a new database, 10 to 1000 (default: the fastest "
                   "recording's, at least 100)")
      ->type_name("HZ");
  verb->add_option("--dimensions", options.pca.dimensions,
                   "PCA dimensions that frames are reduced to")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--share", options.pca.share,
                   "Instead: the least number of dimensions that explains this share of the "
                   "variance, above 0 and up to 1")
      ->type_name("SHARE")
      ->excludes("--dimensions");
  verb->add_option("--gap-limit", options.recordings.gap_limit_s,
                   "Longest run of missing markers that is filled, in seconds")
      ->type_name("SECONDS")
      ->capture_default_str();
  verb->add_option("--tolerance", options.recordings.tolerance_s,
                   "How much longer or shorter than its motion an alignment may be, in seconds")
      ->type_name("SECONDS")
      ->capture_default_str();
  verb->add_flag("--skip-faulty", options.recordings.skip_faulty,
                 "Leave out sentences whose files are faulty (the report names them) instead of "
                 "refusing the corpus");
  verb->add_option("--threads", options.recordings.threads,
                   "Threads to work with (default: one for each core)")
      ->type_name("N");
}

void add_info(CLI::App& app, Words& words) {
  CLI::App* verb = app.add_subcommand("info", "What a motion database holds");
  verb->footer("Example:\n  phonomime info ann.db");
  add_database(verb, words.info.database, false);
}

void add_nodes(CLI::App& app, Words& words) {
  NodeFilter& filter = words.nodes.filter;
  CLI::App* verb =
      app.add_subcommand("nodes", "List motion nodes: the recorded phonemes of a database");
  verb->footer("Example:\n  phonomime nodes ann.db --phoneme aa --emotion happiness --limit 10\n\n"
               "A node is listed where all of the options hold for it.");
  add_database(verb, words.nodes.database, false);
  const auto add = [&](const char* name, std::string& text, const char* meaning) {
    verb->add_option(name, text, meaning)->type_name("NAME");
  };
  add("--phoneme", filter.phoneme, "Only this phoneme");
  add("--emotion", filter.emotion, "Only this emotion");
  add("--speaker", filter.speaker, "Only this speaker");
  add("--sentence", filter.sentence, "Only this sentence (its id)");
  add("--previous", filter.previous_phoneme, "Only after this phoneme (pau is silence)");
  add("--next", filter.next_phoneme, "Only before this phoneme (pau is silence)");
  verb->add_flag("--suspect", words.only_suspect, "Only suspects: jumps, odd durations, stillness");
  verb->add_flag("--pruned", words.only_pruned, "Only those that were taken out of use");
  verb->add_flag("--gaps", words.only_gaps, "Only those with unfilled gaps");
  verb->add_option("--limit", words.nodes.limit, "At most this many (default: all)")
      ->type_name("N");
}

void add_synth_inputs(CLI::App* verb, SynthOptions& options) {
  verb->add_option("--speaker", options.speaker, "Whose recordings, where there are several")
      ->type_name("NAME");
  verb->add_option("--emotion", options.emotion, "One emotion throughout (default: neutral)")
      ->type_name("NAME[:INTENSITY]");
  verb->add_option("--emotions", options.emotions,
                   "Emotion track: a text file of lines START END EMOTION")
      ->type_name("TRACK");
  verb->add_option("--constraints", options.constraints,
                   "Constraint file: which nodes to use or to avoid, and where")
      ->type_name("FILE");
  verb->add_option("--weights", options.weights, "Cost weights of the search (JSON)")
      ->type_name("FILE");
  verb->add_option("--phoneme-set", options.phoneme_set,
                   "The transcript's alphabet: festival_us, arpabet, timit or a .json file "
                   "(default: the first that knows every symbol)")
      ->type_name("SET");
  verb->add_option("--tier", options.tier, "The phone tier of a TextGrid (default: found by name)")
      ->type_name("NAME");
  verb->add_option("--audio", options.audio, "Sound for the player")->type_name("WAV");
  verb->add_option("--face", options.face,
                   "Mesh (.obj, .glb) or the folder with it; needed for .glb and .html")
      ->type_name("FACE");
}

// All that makes motion of a transcript, for every verb that does.
void add_synth_options(CLI::App* verb, Words& words) {
  SynthOptions& options = words.synth.options;
  add_synth_inputs(verb, options);
  verb->add_option("--fps", options.fps, "Output frames a second, 1 to 1000")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--head", words.head,
                   "A constant head pose, also put back into marker CSV, in degrees and mm "
                   "(default: the head rests)")
      ->type_name("YAW,PITCH,ROLL[,X,Y,Z]");
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
  verb->add_option("--runners-up", options.runners_up, "Runners-up for each phoneme, 0 to 100")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--threads", options.threads,
                   "Threads to work with (default: one for each core)")
      ->type_name("N");
}

void add_synth(CLI::App& app, Words& words) {
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
          "mesh), .html (player), .json (the result), .txt (the explanation)")
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

void add_batch(CLI::App& app, Words& words) {
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

void add_explain(CLI::App& app, Words& words) {
  CLI::App* verb = app.add_subcommand("explain", "A synthesis result as a table people read");
  verb->footer("Example:\n  phonomime synth --db ann.db hello.lab -o hello.json\n"
               "  phonomime explain hello.json");
  verb->add_option("result", words.explain.result, "What `synth --json` or `-o FILE.json` gave")
      ->required()
      ->type_name("RESULT");
}

void add_common(CLI::App& app, CommonArguments& common) {
  for (CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    verb->add_flag("--json", common.json, "Report as JSON on stdout");
    verb->add_flag("--quiet", common.quiet, "No progress, no messages but errors");
  }
}

std::optional<bool> only_if(bool flag) {
  return flag ? std::optional(true) : std::nullopt;
}

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands({})) {
    names.push_back(verb->get_name());
  }
  return names;
}

// CLI11 says several things at once; one line is enough for one error.
[[noreturn]] void throw_usage(const CLI::App& app, const CLI::ParseError& error) {
  std::string verb;
  for (const CLI::App* used : app.get_subcommands()) {
    verb = " " + used->get_name();
  }
  throw UsageError({.what = error.what(), .remedy = "See `phonomime" + verb + " --help`."});
}

} // namespace

Arguments parse_arguments(int argc, const char* const* argv) {
  Words words;
  CLI::App app("Expressive speech animation from recorded facial motion", "phonomime");
  app.formatter(std::make_shared<HelpFormatter>());
  app.require_subcommand(1);
  app.set_help_flag("-h,--help", "Print this help");
  app.set_version_flag("--version", std::string("phonomime ") + PHONOMIME_VERSION,
                       "Print the version");
  app.footer("Example:\n  phonomime import recordings/ann --db ann.db\n"
             "  phonomime synth --db ann.db hello.lab --face head.glb -o hello.html\n\n"
             "`phonomime VERB --help` says more of a verb.");
  add_import(app, words);
  add_info(app, words);
  add_nodes(app, words);
  add_synth(app, words);
  add_batch(app, words);
  add_explain(app, words);
  add_common(app, words.arguments.common);
  check_verb(std::span(argv, static_cast<std::size_t>(argc)).subspan(argc > 0 ? 1 : 0),
             verb_names(app));
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    words.arguments.verb = PrintArguments{app.help()};
    return words.arguments;
  } catch (const CLI::CallForVersion&) {
    words.arguments.verb = PrintArguments{app.version() + "\n"};
    return words.arguments;
  } catch (const CLI::ParseError& error) {
    throw_usage(app, error);
  }
  check_limit(words.nodes.limit);
  words.nodes.filter.suspect = only_if(words.only_suspect);
  words.nodes.filter.pruned = only_if(words.only_pruned);
  words.nodes.filter.has_gap = only_if(words.only_gaps);
  if (!words.head.empty()) {
    words.synth.options.head = parse_head(words.head);
  }
  words.synth.options.silence = {.fill = parse_silence(words.silence),
                                 .rest_at_ends = !words.no_rest};
  const std::string verb = app.get_subcommands().front()->get_name();
  if (verb == "import") {
    words.arguments.verb = words.import;
  } else if (verb == "info") {
    words.arguments.verb = words.info;
  } else if (verb == "nodes") {
    words.arguments.verb = words.nodes;
  } else if (verb == "synth" && words.streams) {
    words.stream.synth = words.synth.options;
    if (app.get_subcommands().front()->count("--runners-up") == 0) {
      words.stream.synth.runners_up = 0;
    }
    words.arguments.verb = StreamArguments{words.stream};
  } else if (verb == "synth") {
    words.arguments.verb = words.synth;
  } else if (verb == "batch") {
    words.batch.synth = words.synth.options;
    words.batch.shard = parse_shard(words.shard);
    words.arguments.verb = BatchArguments{words.batch};
  } else {
    words.arguments.verb = words.explain;
  }
  return words.arguments;
}

} // namespace phonomime
