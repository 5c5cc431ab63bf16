// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/named_choice.h"
#include "tools/cli/call_words.h"

#include <CLI/CLI.hpp>

namespace phonomime {

namespace {

void add_select(CLI::App* keyshapes, RetargetWords& words) {
  ChooseKeyshapesOptions& options = words.choose.options;
  CLI::App* verb = keyshapes->add_subcommand("select", "Frames that cover the recorded motion");
  verb->footer("Example:\n  phonomime retarget keyshapes select ann.db -o keys --face head.glb \\\n"
               "      --parts lower upper\n\n"
               "The folder gets the frames, pictures and meshes of them, how much error they\n"
               "leave, and a rig.json that says what your character does for each.");
  add_database(verb, options.database, false);
  verb->add_option("-o,--output", options.output, "Folder for what is written")
      ->required()
      ->type_name("FOLDER");
  verb->add_option("--face", options.face,
                   "Mesh to show each keyshape on, as .png and .glb; weights of its own shapes "
                   "are proposed")
      ->type_name("FACE");
  verb->add_option("--target", options.target,
                   "What the rig is for: shapes, mesh, joints or drawing")
      ->type_name("KIND")
      ->capture_default_str();
  verb->add_option("--parts", options.parts,
                   "Parts of the face, each with keyshapes of its own: face, upper, lower or a "
                   "region")
      ->type_name("PART...")
      ->capture_default_str();
  verb->add_flag("--by-emotion", options.by_emotion, "A set of keyshapes for each emotion");
  add_speaker(verb, options.speaker);
  verb->add_option("--method", words.keyshape_method, "How: extrema, hull or clusters")
      ->type_name("METHOD")
      ->capture_default_str();
  verb->add_option("-n,--count", options.keyshapes.count, "Keyshapes in each set")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--similar", options.keyshapes.similar,
                   "Extrema nearer than this to one before them are left out, as a share of the "
                   "frames' spread")
      ->type_name("SHARE")
      ->capture_default_str();
  verb->add_option("--dimensions", options.keyshapes.cluster_dimensions,
                   "PCA dimensions in which clusters are looked for")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--seed", options.keyshapes.seed, "Of the lots that clusters begin with")
      ->type_name("SEED")
      ->capture_default_str();
}

void add_apply(CLI::App* keyshapes, RetargetWords& words) {
  ApplyRigOptions& options = words.rig.options;
  CLI::App* verb = keyshapes->add_subcommand("apply", "Motion onto a rig's target");
  verb->footer("Example:\n  phonomime retarget keyshapes apply hello.csv --db ann.db \\\n"
               "      --rig keys/rig.json -o hello.svg\n\n"
               "A rig of a face's shapes gives a table here;\n"
               "`retarget apply --method keyshapes --rig RIG` moves the face itself.");
  verb->add_option("motion", options.motion, "Motion: .csv or .c3d")
      ->required()
      ->type_name("MOTION");
  add_database(verb, options.database, true);
  verb->add_option("--rig", options.choice.rig, "What the target does for each keyshape")
      ->required()
      ->type_name("RIG");
  verb->add_option("-o,--output", options.outputs,
                   "Outputs: .csv; .svg of a drawing; .glb of a figure or a mesh")
      ->required()
      ->type_name("FILE...");
  add_speaker(verb, options.speaker);
  verb->add_option("--layout", options.layout,
                   "The layout.json of the motion, where its unit or axes are not the database's")
      ->type_name("FILE");
  add_expression(verb, options.choice);
  verb->add_option("--largest", options.weights.largest, "Largest weight (default: no limit)")
      ->type_name("W");
  add_weight_choices(verb, options.weights, options.filter_s);
  verb->add_option("--fps", options.fps, "Frames a second (default: the database's)")
      ->type_name("FPS");
}

} // namespace

void add_keyshapes(CLI::App& retarget, RetargetWords& words) {
  CLI::App* keyshapes = retarget.add_subcommand(
      "keyshapes", "Poses that cover the motion, and characters posed by them");
  keyshapes->require_subcommand(1);
  keyshapes->footer("Example:\n  phonomime retarget keyshapes select ann.db -o keys\n\n"
                    "`phonomime retarget keyshapes VERB --help` says more of a verb; so does\n"
                    "docs/retargeting.md.");
  add_select(keyshapes, words);
  add_apply(keyshapes, words);
}

void take_keyshapes_words(const CLI::App& keyshapes, CallWords& words) {
  RetargetWords& own = words.retarget;
  if (keyshapes.get_subcommands().front()->get_name() == "select") {
    own.choose.options.keyshapes.method = static_cast<KeyshapeMethod>(
        named_choice("--method", own.keyshape_method, kKeyshapeMethodNames));
    words.arguments.verb = own.choose;
  } else {
    words.arguments.verb = own.rig;
  }
}

} // namespace phonomime
