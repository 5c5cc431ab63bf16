// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/arguments.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <array>
#include <map>
#include <numbers>
#include <optional>

#include <CLI/CLI.hpp>

namespace phonomime {

namespace {

// What the words of the call are put into before a verb's struct is made of them.
struct Words {
  Arguments arguments;
  ImportArguments import;
  InfoArguments info;
  NodesArguments nodes;
  SynthArguments synth;
  ExplainArguments explain;
  bool only_suspect = false, only_pruned = false, only_gaps = false;
  double share = 0.0;
  std::string head;
};

// "yaw,pitch,roll[,x,y,z]": degrees about y (up), x (right of the picture), z (towards the camera),
// applied in the order roll, pitch, yaw; millimetres.
HeadPose parse_head(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string_view field : split_fields(text, ',')) {
    const std::optional<double> number = parse_number(trim(field));
    if (!number) {
      break;
    }
    numbers.push_back(*number);
  }
  if ((numbers.size() != 3 && numbers.size() != 6) ||
      numbers.size() != split_fields(text, ',').size()) {
    throw UsageError({.where = "--head",
                      .what = "is not a head pose",
                      .expected = "YAW,PITCH,ROLL or YAW,PITCH,ROLL,X,Y,Z (degrees, mm)",
                      .got = quoted(text)});
  }
  const auto about = [&](std::size_t i, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(numbers[i] * std::numbers::pi / 180.0, axis);
  };
  HeadPose pose;
  pose.rotation = about(0, Eigen::Vector3d::UnitY()) * about(1, Eigen::Vector3d::UnitX()) *
                  about(2, Eigen::Vector3d::UnitZ());
  if (numbers.size() == 6) {
    pose.translation_mm = {numbers[3], numbers[4], numbers[5]};
  }
  return pose;
}

void add_database(CLI::App* verb, std::filesystem::path& database, bool option) {
  auto* added = option ? verb->add_option("--db", database, "The motion database")
                       : verb->add_option("database", database, "The motion database");
  added->required()->type_name("DB");
}

void add_import(CLI::App& app, Words& words) {
  ImportOptions& options = words.import.options;
  CLI::App* verb = app.add_subcommand("import", "Put a corpus folder into a motion database");
  verb->footer("Example:\n  phonomime import recordings/ann --db ann.db\n\n"
               "The database is made where it does not exist, else added to; an import that fails\n"
               "or is stopped changes nothing. corpora_schema/corpus.md describes the folder.");
  verb->add_option("corpus", options.corpus, "The folder with corpus.json")
      ->required()
      ->type_name("FOLDER");
  add_database(verb, options.database, true);
  verb->add_option("--rate", options.rate_hz,
                   "Frames a second of a new database (default: the fastest recording's, at least "
                   "100)")
      ->type_name("HZ");
  verb->add_option("--dimensions", options.pca.dimensions, "PCA dimensions")->capture_default_str();
  verb->add_option("--share", words.share,
                   "Instead: the least number of dimensions that explains this share of the "
                   "variance")
      ->check(CLI::Range(0.0, 1.0))
      ->excludes("--dimensions");
  verb->add_option("--gap-limit", options.recordings.gap_limit_s,
                   "Longest run of missing markers that is filled, in seconds")
      ->capture_default_str();
  verb->add_option("--tolerance", options.recordings.tolerance_s,
                   "How far an alignment may run past its motion, in seconds")
      ->capture_default_str();
  verb->add_flag("--skip-faulty", options.recordings.skip_faulty,
                 "Leave out sentences whose files are faulty (the report names them) instead of "
                 "refusing the corpus");
  verb->add_option("--threads", options.recordings.threads, "Threads (0: one for each core)")
      ->check(CLI::Range(0, 256));
}

void add_info(CLI::App& app, Words& words) {
  CLI::App* verb = app.add_subcommand("info", "What a motion database holds");
  verb->footer("Example:\n  phonomime info ann.db");
  add_database(verb, words.info.database, false);
}

void add_nodes(CLI::App& app, Words& words) {
  NodeFilter& filter = words.nodes.filter;
  CLI::App* verb = app.add_subcommand("nodes", "List motion nodes");
  verb->footer("Example:\n  phonomime nodes ann.db --phoneme aa --emotion happiness --limit 10");
  add_database(verb, words.nodes.database, false);
  verb->add_option("--phoneme", filter.phoneme, "Only this phoneme");
  verb->add_option("--emotion", filter.emotion, "Only this emotion");
  verb->add_option("--speaker", filter.speaker, "Only this speaker");
  verb->add_option("--sentence", filter.sentence, "Only this sentence (its id)");
  verb->add_option("--previous", filter.previous_phoneme, "Only after this phoneme");
  verb->add_option("--next", filter.next_phoneme, "Only before this phoneme");
  verb->add_flag("--suspect", words.only_suspect, "Only suspects");
  verb->add_flag("--pruned", words.only_pruned, "Only pruned ones");
  verb->add_flag("--gaps", words.only_gaps, "Only those with unfilled gaps");
  verb->add_option("--limit", words.nodes.limit, "At most this many")
      ->check(CLI::NonNegativeNumber);
}

void add_synth(CLI::App& app, Words& words) {
  SynthOptions& options = words.synth.options;
  CLI::App* verb = app.add_subcommand("synth", "A transcript in, a talking face out");
  verb->footer("Example:\n  phonomime synth --db ann.db hello.lab --emotions hello.emotions \\\n"
               "      --constraints hello.constraints --audio hello.wav --face head.glb \\\n"
               "      -o hello.html -o hello.glb -o hello.csv");
  add_database(verb, options.database, true);
  verb->add_option("transcript", options.transcript,
                   "Phonemes with times: .lab (Festival, HTK) or .TextGrid")
      ->required()
      ->type_name("TRANSCRIPT");
  verb->add_option(
          "-o,--output", options.outputs,
          "Output; its suffix says what: .csv (marker or Live Link motion), .glb (animated "
          "mesh), .html (player), .json (the result), .txt (the explanation)")
      ->type_name("FILE...");
  verb->add_option("--speaker", options.speaker, "Whose recordings, where there are several");
  verb->add_option("--emotion", options.emotion, "One emotion throughout (default: neutral)")
      ->type_name("NAME[:INTENSITY]");
  verb->add_option("--emotions", options.emotions, "Emotion track")->type_name("TRACK");
  verb->add_option("--constraints", options.constraints, "Constraint file")->type_name("FILE");
  verb->add_option("--weights", options.weights, "Cost weights")->type_name("FILE");
  verb->add_option("--phoneme-set", options.phoneme_set,
                   "The transcript's alphabet: festival_us, arpabet, timit or a .json file "
                   "(default: the first that knows every symbol)");
  verb->add_option("--tier", options.tier, "The phone tier of a TextGrid (default: found by name)");
  verb->add_option("--audio", options.audio, "Sound for the player")->type_name("WAV");
  verb->add_option("--face", options.face, "Mesh (.obj, .glb) or the folder with it")
      ->type_name("FACE");
  verb->add_option("--fps", options.fps, "Output frames a second")->capture_default_str();
  verb->add_option("--head", words.head,
                   "A constant head pose, also put back into marker CSV (default: the head rests): "
                   "degrees and mm")
      ->type_name("YAW,PITCH,ROLL[,X,Y,Z]");
  verb->add_option("--silence", options.silence.fill, "How inner silence is filled")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, SilenceFill>{{"linear", SilenceFill::linear},
                                             {"cosine", SilenceFill::cosine},
                                             {"cubic", SilenceFill::cubic}}))
      ->default_str("linear");
  verb->add_flag("!--no-rest", options.silence.rest_at_ends,
                 "Hold the first and the last pose through silence at the ends");
  verb->add_option("--smoothing", options.smoothing_half_window,
                   "Frames on either side of a join that are smoothed")
      ->capture_default_str();
  verb->add_option("--runners-up", options.runners_up, "Runners-up for each phoneme")
      ->capture_default_str();
  verb->add_option("--threads", options.threads, "Threads (0: one for each core)")
      ->check(CLI::Range(0, 256));
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
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("phonomime ") + PHONOMIME_VERSION);
  add_import(app, words);
  add_info(app, words);
  add_nodes(app, words);
  add_synth(app, words);
  add_explain(app, words);
  add_common(app, words.arguments.common);
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
  if (words.share > 0.0) {
    words.import.options.pca.share = words.share;
  }
  words.nodes.filter.suspect = only_if(words.only_suspect);
  words.nodes.filter.pruned = only_if(words.only_pruned);
  words.nodes.filter.has_gap = only_if(words.only_gaps);
  if (!words.head.empty()) {
    words.synth.options.head = parse_head(words.head);
  }
  const std::string verb = app.get_subcommands().front()->get_name();
  if (verb == "import") {
    words.arguments.verb = words.import;
  } else if (verb == "info") {
    words.arguments.verb = words.info;
  } else if (verb == "nodes") {
    words.arguments.verb = words.nodes;
  } else if (verb == "synth") {
    words.arguments.verb = words.synth;
  } else {
    words.arguments.verb = words.explain;
  }
  return words.arguments;
}

} // namespace phonomime
