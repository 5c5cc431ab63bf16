// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/retarget_reports.h"
#include "tools/cli/terminal.h"
#include "tools/cli/verbs.h"

#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

void print_report(const CommonArguments& common, const nlohmann::ordered_json& json,
                  const std::string& text) {
  clear_progress();
  if (common.json || !common.quiet) {
    print(common.json ? json.dump(1) + "\n" : text);
  }
}

} // namespace

void run_verb(const RetargetListArguments& arguments, const CommonArguments& common,
              const Progress&) {
  const FaceOffer offer = list_face(arguments.options);
  print(common.json ? face_offer_json(offer).dump(1) + "\n" : face_offer_text(offer));
}

void run_verb(const RetargetApplyArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const RetargetReport report = apply_to_face(arguments.options, progress);
  print_report(common, retarget_json(report), retarget_text(report));
}

void run_verb(const RetargetReferencesArguments& arguments, const CommonArguments& common,
              const Progress&) {
  const ReferencesReport report = propose_pairs(arguments.options);
  print_report(common, references_json(report), references_text(report));
}

void run_verb(const ChooseKeyshapesArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const ChooseKeyshapesReport report = write_keyshapes(arguments.options, progress);
  print_report(common, keyshapes_json(report), keyshapes_text(report, arguments.options.output));
}

void run_verb(const ApplyRigArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const ApplyRigReport report = apply_rig(arguments.options, progress);
  print_report(common, rig_json(report), rig_text(report));
}

} // namespace phonomime
