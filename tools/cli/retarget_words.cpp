// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/call_words.h"

#include <CLI/CLI.hpp>

namespace phonomime {

namespace {

void add_face(CLI::App* verb, std::filesystem::path& face, bool option) {
  auto* added = option ? verb->add_option("--face", face, "The face: a .glb or the folder with it")
                       : verb->add_option("face", face, "The face: a .glb or the folder with it");
  added->required()->type_name("FACE");
}

void add_retarget_list(CLI::App* retarget, RetargetWords& words) {
  RetargetListOptions& options = words.list.options;
  CLI::App* verb = retarget->add_subcommand("list", "What a face offers: shapes, meshes, nodes");
  verb->footer("Example:\n  phonomime retarget list head.glb --db ann.db\n\n"
               "The millimetres of a shape are how far it moves the vertex that it moves most.\n"
               "`phonomime retarget --list FACE` is the same.");
  add_face(verb, options.face, false);
  verb->add_option("--db", options.database, "Whose markers are looked for on the face")
      ->type_name("DB");
}

void add_retarget_apply(CLI::App* retarget, RetargetWords& words) {
  RetargetApplyOptions& options = words.apply.options;
  CLI::App* verb = retarget->add_subcommand("apply", "Motion as weights of a face's shapes");
  verb->footer("Example:\n  phonomime retarget apply hello.csv --db ann.db --face head.glb \\\n"
               "      -o hello.glb hello.maya.py hello.livelink.csv\n\n"
               "Motion of weights goes to the shapes of their names, in any usual spelling.\n"
               "docs/retargeting.md tells of the methods and the files.");
  verb->add_option("motion", options.motion, "Motion: .csv (markers, weights, Live Link) or .c3d")
      ->required()
      ->type_name("MOTION");
  add_face(verb, options.face, true);
  verb->add_option("-o,--output", options.outputs,
                   "Outputs: .glb, .html, .csv (weights), .livelink.csv, .bvh (head), .maya.py, "
                   ".blender.py")
      ->required()
      ->type_name("FILE...");
  verb->add_option("--db", options.database, "The database whose markers the motion has")
      ->type_name("DB");
  add_speaker(verb, options.speaker);
  verb->add_option("--layout", options.layout,
                   "The layout.json of the motion, where its unit or axes are not the database's")
      ->type_name("FILE");
  verb->add_option("--method", options.method,
                   "How: weights (by their names), fit, cross, equations or keyshapes (default: "
                   "weights for weights, else fit)")
      ->type_name("METHOD");
  verb->add_option("--pairs", options.pairs, "Frames with their weights, for cross")
      ->type_name("TABLE");
  verb->add_option("--dimensions", options.dimensions,
                   "PCA dimensions that cross looks at; 0: by cross-validation (default: 4)")
      ->type_name("N");
  verb->add_option("--rig", options.rig.rig, "What the face does for each keyshape, for keyshapes")
      ->type_name("RIG");
  add_expression(verb, options.rig);
  add_weight_choices(verb, options.weights, options.filter_s);
  verb->add_option("--fps", options.fps, "Frames a second (default: as the motion has)")
      ->type_name("FPS");
  verb->add_option("--audio", options.audio, "Sound for the HTML page")->type_name("FILE");
  verb->add_flag_callback(
      "--no-head", [&options] { options.head = false; }, "The head rests");
  verb->add_flag("--skip-missing", options.skip_missing,
                 "Leave out weights of shapes that the face does not have");
}

void add_retarget_references(CLI::App* retarget, RetargetWords& words) {
  RetargetReferencesOptions& options = words.references.options;
  CLI::App* verb = retarget->add_subcommand("references", "Frames to give weights, for cross");
  verb->footer("Example:\n  phonomime retarget references ann.db --face head.glb -o pairs.tsv\n\n"
               "One frame for each viseme and emotion, then those farthest from all before.\n"
               "Weights stand there as `fit` finds them, to be changed by hand.");
  verb->add_option("db", options.database, "The motion database")->required()->type_name("DB");
  add_face(verb, options.face, true);
  verb->add_option("-o,--output", options.output, "The pair table (.tsv)")
      ->required()
      ->type_name("FILE");
  add_speaker(verb, options.speaker);
  verb->add_option("--extremes", options.references.extremes, "Extreme frames for each emotion")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--dimensions", options.references.dimensions,
                   "Dimensions of the PCA in which frames are near or far")
      ->type_name("N")
      ->capture_default_str();
}

} // namespace

void add_weight_choices(CLI::App* verb, WeightChoices& weights, double& filter_s) {
  verb->add_option("--ridge", weights.ridge,
                   "Keeps weights small, for fit (default: 0.0002) and keyshapes (default: 0)")
      ->type_name("R");
  verb->add_option("--sparsity", weights.sparsity,
                   "Pulls each weight to 0 by about this much, for fit (default: 0.0001) and "
                   "keyshapes (default: 0)")
      ->type_name("W");
  verb->add_option("--smoothness", weights.smoothness,
                   "Frames over which weights are smoothed as they are solved for, for fit "
                   "(default: 0.1) and keyshapes (default: 0)")
      ->type_name("FRAMES");
  verb->add_option("--filter", filter_s,
                   "Smooth the weights afterwards by a bell this wide in seconds, 0 (none) to 1")
      ->type_name("SECONDS")
      ->capture_default_str();
}

void add_expression(CLI::App* verb, RigChoice& choice) {
  verb->add_option("--emotion", choice.emotion,
                   "Expression of a rig that has several, as NAME, NAME:INTENSITY or a mixture "
                   "NAME:I+NAME:I (default: neutral, else its first)")
      ->type_name("EMOTION");
  verb->add_option("--emotions", choice.emotions, "Emotion track that blends a rig's expressions")
      ->type_name("TRACK");
}

void add_retarget(CLI::App& app, CallWords& words) {
  CLI::App* retarget = app.add_subcommand("retarget", "Motion onto a face with shapes of its own");
  retarget->require_subcommand(1);
  retarget->footer("Example:\n  phonomime retarget list head.glb\n\n"
                   "`phonomime retarget VERB --help` says more of a verb; so does\n"
                   "docs/retargeting.md.");
  add_retarget_list(retarget, words.retarget);
  add_retarget_apply(retarget, words.retarget);
  add_retarget_references(retarget, words.retarget);
  add_keyshapes(*retarget, words.retarget);
}

void take_retarget_words(const CLI::App& retarget, CallWords& words) {
  const std::string verb = retarget.get_subcommands().front()->get_name();
  if (verb == "list") {
    words.arguments.verb = words.retarget.list;
  } else if (verb == "references") {
    words.arguments.verb = words.retarget.references;
  } else if (verb == "keyshapes") {
    take_keyshapes_words(*retarget.get_subcommands().front(), words);
  } else {
    words.arguments.verb = words.retarget.apply;
  }
}

} // namespace phonomime
