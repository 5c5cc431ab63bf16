// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/arguments.h"

#include "db/types/errors.h"
#include "tools/app/retime.h"
#include "tools/cli/call_words.h"
#include "tools/cli/help.h"
#include "tools/cli/words.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

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

void add_import(CLI::App& app, CallWords& words) {
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
  add_scale(verb, words);
  verb->add_flag("--skip-faulty", options.recordings.skip_faulty,
                 "Leave out sentences whose files are faulty (the report names them) instead of "
                 "refusing the corpus");
  verb->add_option("--threads", options.recordings.threads,
                   "Threads to work with (default: one for each core)")
      ->type_name("N");
}

void add_info(CLI::App& app, CallWords& words) {
  CLI::App* verb = app.add_subcommand("info", "What a motion database holds");
  verb->footer("Example:\n  phonomime info ann.db");
  add_database(verb, words.info.database, false);
}

void add_explain(CLI::App& app, CallWords& words) {
  CLI::App* verb = app.add_subcommand("explain", "A synthesis result as a table people read");
  verb->footer("Example:\n  phonomime synth --db ann.db hello.lab -o hello.json\n"
               "  phonomime explain hello.json");
  verb->add_option("result", words.explain.result, "What `synth --json` or `-o FILE.json` gave")
      ->required()
      ->type_name("RESULT");
}

// Of a verb that has verbs of its own each of those gets them.
void add_common(CLI::App& app, CommonArguments& common) {
  for (CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!verb->get_subcommands({}).empty()) {
      add_common(*verb, common);
      continue;
    }
    verb->add_flag("--json", common.json, "Report as JSON on stdout");
    verb->add_flag("--quiet", common.quiet, "No progress, no messages but errors");
  }
}

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands({})) {
    names.push_back(verb->get_name());
  }
  return names;
}

// The call's verb, and the verb's own where it has some. `name`: what the program is called up to
// there.
void check_verbs(const CLI::App& app, std::span<const char* const> call, const std::string& name) {
  check_verb(call, verb_names(app), name);
  for (const CLI::App* verb : app.get_subcommands({})) {
    if (!call.empty() && call.front() == verb->get_name() && !verb->get_subcommands({}).empty()) {
      check_verbs(*verb, call.subspan(1), name + " " + verb->get_name());
    }
  }
}

// CLI11 says several things at once; one line is enough for one error.
[[noreturn]] void throw_usage(const CLI::App& app, const CLI::ParseError& error) {
  std::string verb;
  for (const CLI::App* used = &app; !used->get_subcommands().empty();) {
    used = used->get_subcommands().front();
    verb += " " + used->get_name();
  }
  throw UsageError({.what = error.what(), .remedy = "See `phonomime" + verb + " --help`."});
}

} // namespace

void add_database(CLI::App* verb, std::filesystem::path& database, bool option) {
  auto* added = option ? verb->add_option("--db", database, "The motion database")
                       : verb->add_option("database", database, "The motion database");
  added->required()->type_name("DB");
}

void add_speaker(CLI::App* verb, std::string& speaker) {
  verb->add_option("--speaker", speaker, "Whose recordings, where there are several")
      ->type_name("NAME");
}

void add_scale(CLI::App* verb, CallWords& words) {
  verb->add_option("--scale", words.scale,
                   "What millimetres are: measured, or nominal (one camera: frames are brought to "
                   "one size of the head); default: as the layout says, else found out")
      ->type_name("SCALE");
}

Arguments parse_arguments(int argc, const char* const* argv) {
  CallWords words;
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
  add_curation(app, words);
  add_synth(app, words);
  add_batch(app, words);
  add_evaluate(app, words);
  add_tune(app, words);
  add_explain(app, words);
  add_map(app, words);
  add_recommend(app, words);
  add_retarget(app, words);
  add_style(app, words);
  add_common(app, words.arguments.common);
  std::vector<const char*> call(argv, argv + argc);
  if (call.size() > 2 && call[1] == std::string_view("retarget") &&
      call[2] == std::string_view("--list")) {
    call[2] = "list";
  }
  check_verbs(app, std::span(call).subspan(call.empty() ? 0 : 1), app.get_name());
  try {
    app.parse(argc, call.data());
  } catch (const CLI::CallForHelp&) {
    words.arguments.verb = PrintArguments{app.help()};
    return words.arguments;
  } catch (const CLI::CallForVersion&) {
    words.arguments.verb = PrintArguments{app.version() + "\n"};
    return words.arguments;
  } catch (const CLI::ParseError& error) {
    throw_usage(app, error);
  }
  if (!words.head.empty()) {
    words.synth.options.head = parse_head(words.head);
  }
  words.synth.options.cost = parse_cost(words.cost);
  words.synth.options.silence = {.fill = parse_silence(words.silence),
                                 .rest_at_ends = !words.no_rest};
  words.evaluate.options.synth.silence = words.synth.options.silence;
  words.tune.options.synth.silence = words.synth.options.silence;
  words.tune.options.synth.cost = words.synth.options.cost;
  words.import.options.recordings.scale = parse_scale(words.scale);
  words.evaluate.options.import.recordings.scale = words.import.options.recordings.scale;
  words.tune.options.import.recordings.scale = words.import.options.recordings.scale;
  const std::string verb = app.get_subcommands().front()->get_name();
  if (verb == "map") {
    take_map_words(*app.get_subcommands().front(), words);
  } else if (verb == "retarget") {
    take_retarget_words(*app.get_subcommands().front(), words);
  } else if (verb == "style") {
    take_style_words(*app.get_subcommands().front(), words);
  } else if (verb == "recommend") {
    words.recommend.options.synth = words.synth.options;
    words.arguments.verb = words.recommend;
  } else if (verb == "import") {
    words.arguments.verb = words.import;
  } else if (verb == "info") {
    words.arguments.verb = words.info;
  } else if (take_curation_words(*app.get_subcommands().front(), words)) {
    return words.arguments;
  } else if (verb == "synth" && words.streams) {
    words.stream.synth = words.synth.options;
    if (app.get_subcommands().front()->count("--runners-up") == 0) {
      words.stream.synth.runners_up = 0;
    }
    words.arguments.verb = StreamArguments{words.stream};
  } else if (verb == "synth") {
    add_retimed_transcript(words.synth.options);
    words.arguments.verb = words.synth;
  } else if (verb == "batch") {
    words.batch.synth = words.synth.options;
    words.batch.shard = parse_shard(words.shard);
    words.arguments.verb = BatchArguments{words.batch};
  } else if (verb == "evaluate") {
    words.arguments.verb = words.evaluate;
  } else if (verb == "tune") {
    words.arguments.verb = words.tune;
  } else {
    words.arguments.verb = words.explain;
  }
  return words.arguments;
}

} // namespace phonomime
