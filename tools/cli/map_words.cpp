// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/call_words.h"
#include "tools/cli/words.h"

#include <string>
#include <tuple>
#include <vector>

#include <CLI/CLI.hpp>

namespace phonomime {

namespace {

void add_map_threads(CLI::App* verb, int& threads) {
  verb->add_option("--threads", threads, "Threads to work with (default: one for each core)")
      ->type_name("N");
}

void add_phonemes(CLI::App* verb, std::vector<std::string>& phonemes) {
  verb->add_option("--phoneme", phonemes, "Only these phonemes (default: all that have nodes)")
      ->type_name("NAME...");
}

void add_phoneme(CLI::App* verb, std::string& phoneme) {
  verb->add_option("phoneme", phoneme, "The phoneme whose map it is")
      ->required()
      ->type_name("PHONEME");
}

void add_map_kind(CLI::App* verb, MapWords& words) {
  verb->add_option("--map", words.kind, "Which map: isomap or pca")
      ->type_name("MAP")
      ->capture_default_str();
}

void add_map_build(CLI::App* map, MapWords& words) {
  MapBuildOptions& options = words.build.options;
  CLI::App* verb = map->add_subcommand("build", "Make and store the maps of all phonemes");
  verb->footer("Example:\n  phonomime map build ann.db\n\n"
               "Maps that are fresh are left as they are; what was made before a stop is kept.");
  add_database(verb, options.database, false);
  add_speaker(verb, options.speaker);
  add_phonemes(verb, options.phonemes);
  verb->add_option("-k,--neighbours", options.isomap.neighbours,
                   "Nearest frames that each frame is joined to")
      ->type_name("K")
      ->capture_default_str();
  verb->add_option("--components", words.components,
                   "Parts that no path of neighbours joins: join (by their shortest edges) or "
                   "largest (only that part is on the map)")
      ->type_name("HOW")
      ->capture_default_str();
  verb->add_option("--largest-exact", options.isomap.largest_exact,
                   "Most frames whose map is exact; those of larger ones are placed by landmarks")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--landmarks", options.isomap.landmarks, "Landmarks of a larger one")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--seed", options.isomap.seed, "Of the lots by which landmarks are drawn")
      ->type_name("SEED")
      ->capture_default_str();
  add_map_threads(verb, options.isomap.threads);
}

void add_map_show(CLI::App* map, MapWords& words) {
  CLI::App* verb = map->add_subcommand("show", "Which maps there are, and whether they are fresh");
  verb->footer("Example:\n  phonomime map show ann.db aa");
  add_database(verb, words.show.database, false);
  verb->add_option("phoneme", words.show.phoneme, "Only this phoneme")->type_name("PHONEME");
  add_speaker(verb, words.show.speaker);
}

void add_map_image(CLI::App* map, MapWords& words) {
  MapImageOptions& options = words.image.options;
  CLI::App* verb = map->add_subcommand("image", "A map as a picture");
  verb->footer("Example:\n  phonomime map image ann.db aa -o aa.png --time-correct 0.5 \\\n"
               "      --context b d\n\n"
               "Colours are emotions, their depth is how many frames lie there; lines are\n"
               "motion nodes. docs/maps.md explains what is drawn.");
  add_database(verb, options.database, false);
  add_phoneme(verb, options.phoneme);
  verb->add_option("-o,--output", options.outputs, "Pictures: .png, .svg")
      ->required()
      ->type_name("FILE...");
  add_speaker(verb, options.speaker);
  add_map_kind(verb, words);
  verb->add_option("--time-correct", options.relative_time,
                   "Mark where every node is at this relative time, 0 to 1")
      ->type_name("T");
  verb->add_option("--context", words.context, "Highlight nodes recorded between these phonemes")
      ->type_name("PREVIOUS NEXT")
      ->expected(2);
  verb->add_option("--path", options.path,
                   "Highlight the nodes that a synthesis chose (what `synth -o FILE.json` gave)")
      ->type_name("RESULT");
  verb->add_option("--nodes", options.chosen, "Highlight these nodes")->type_name("KEY...");
  verb->add_flag("--suspects", options.suspects, "Highlight suspects");
  verb->add_flag("--pruned", options.pruned,
                 "Show pruned nodes too, where the frames are that are most like theirs");
  verb->add_flag_callback(
      "--only-highlights", [&options] { options.trajectories = false; },
      "No trajectories but highlighted ones");
  verb->add_option("--palette", words.palette, "Colours of emotions, as happiness=#f0a000")
      ->type_name("EMOTION=COLOUR,...")
      ->delimiter(',');
  verb->add_option("--size", words.size, "Of the map in pixels, 64 to 8192 a side")
      ->type_name("WIDTHxHEIGHT")
      ->capture_default_str();
  verb->add_option("--sigma", options.picture.density.sigma_px,
                   "Spread of each frame's density in pixels, 0.5 to 500")
      ->type_name("PIXELS")
      ->capture_default_str();
  verb->add_flag_callback(
      "--no-legend", [&options] { options.picture.legend = false; }, "No title, no legend");
  add_map_threads(verb, options.threads);
}

void add_map_pick(CLI::App* map, MapWords& words) {
  MapPickOptions& options = words.pick.options;
  CLI::App* verb = map->add_subcommand("pick", "The motion frame at a place of a map");
  verb->footer("Example:\n  phonomime map pick ann.db aa -3.5 12 --face head.glb -o aa.glb\n\n"
               "Inside the hull of the map's frames it is interpolated between the three that\n"
               "surround the place; outside it is the nearest one.");
  add_database(verb, options.database, false);
  add_phoneme(verb, options.phoneme);
  verb->add_option("x", options.x, "To the right, in the map's unit")->required()->type_name("X");
  verb->add_option("y", options.y, "Up")->required()->type_name("Y");
  add_speaker(verb, options.speaker);
  add_map_kind(verb, words);
  verb->add_option("--face", options.face, "Mesh (.obj, .glb) or the folder with it; for .glb")
      ->type_name("FACE");
  verb->add_option("-o,--output", options.outputs, "The motion frame: .glb (mesh), .csv (markers)")
      ->type_name("FILE...");
  add_map_threads(verb, options.threads);
}

void add_map_quality(CLI::App* map, MapWords& words) {
  CLI::App* verb = map->add_subcommand("quality", "How well Isomap and PCA maps show the frames");
  verb->footer("Example:\n  phonomime map quality ann.db --csv\n\n"
               "docs/maps.md explains the measures.");
  add_database(verb, words.quality.options.database, false);
  add_speaker(verb, words.quality.options.speaker);
  add_phonemes(verb, words.quality.options.phonemes);
  verb->add_flag("--csv", words.quality.csv, "A line for each phoneme and map, between commas");
  add_map_threads(verb, words.quality.options.threads);
}

} // namespace

void add_map(CLI::App& app, CallWords& words) {
  CLI::App* map = app.add_subcommand("map", "Phoneme-Isomaps: all motion of a phoneme on a map");
  map->require_subcommand(1);
  map->footer(
      "Example:\n  phonomime map build ann.db\n  phonomime map image ann.db aa -o aa.png\n\n"
      "`phonomime map VERB --help` says more of a verb; so does docs/maps.md.");
  add_map_build(map, words.map);
  add_map_show(map, words.map);
  add_map_image(map, words.map);
  add_map_pick(map, words.map);
  add_map_quality(map, words.map);
}

void add_recommend(CLI::App& app, CallWords& words) {
  RecommendOptions& options = words.recommend.options;
  CLI::App* verb =
      app.add_subcommand("recommend", "Which nodes to use for a phoneme of a transcript");
  verb->footer("Example:\n  phonomime recommend ann.db hello.lab --row 12 --emotion happiness\n\n"
               "Nodes of the same triphone come first, then by what the best path through each\n"
               "costs more. A line can be pasted into a constraint file\n"
               "(corpora_schema/constraints.md).");
  add_database(verb, words.synth.options.database, false);
  verb->add_option("transcript", words.synth.options.transcript,
                   "Phonemes with times: .lab (Festival, HTK) or .TextGrid")
      ->required()
      ->type_name("TRANSCRIPT");
  CLI::Option* row = verb->add_option("--row", options.row,
                                      "The phoneme: a row of the transcript, counted from 0, "
                                      "silence too")
                         ->type_name("I");
  verb->add_option("--at-time", options.relative_time,
                   "Which moment of the phoneme matters, from 0 (its start) to 1 (its end)")
      ->type_name("T")
      ->needs(row)
      ->capture_default_str();
  verb->add_option("--time", options.time_s,
                   "Instead: a time of the transcript in seconds, which gives both")
      ->type_name("SECONDS")
      ->excludes(row);
  verb->add_option("--limit", options.limit, "At most this many, 1 to 1000")
      ->type_name("N")
      ->capture_default_str();
  add_transcript_options(verb, words);
  add_map_threads(verb, words.synth.options.threads);
}

void take_map_words(const CLI::App& map, CallWords& words) {
  MapWords& own = words.map;
  own.build.options.isomap.disconnected = parse_components(own.components);
  own.image.options.pca = own.pick.options.pca = parse_map_kind(own.kind);
  own.image.options.palette = parse_palette(own.palette);
  std::tie(own.image.options.picture.width_px, own.image.options.picture.height_px) =
      parse_size(own.size);
  if (!own.context.empty()) {
    own.image.options.previous = own.context.at(0);
    own.image.options.next = own.context.at(1);
  }
  const std::string verb = map.get_subcommands().front()->get_name();
  if (verb == "build") {
    words.arguments.verb = own.build;
  } else if (verb == "show") {
    words.arguments.verb = own.show;
  } else if (verb == "image") {
    words.arguments.verb = own.image;
  } else if (verb == "pick") {
    words.arguments.verb = own.pick;
  } else {
    words.arguments.verb = own.quality;
  }
}

} // namespace phonomime
