// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/print_report.h"
#include "tools/cli/retarget_reports.h"
#include "tools/cli/verbs.h"

#include <nlohmann/json.hpp>

namespace phonomime {

void run_verb(const RetargetListArguments& arguments, const CommonArguments& common,
              const Progress&) {
  const FaceOffer offer = list_face(arguments.options);
  print_answer(common, face_offer_json(offer), face_offer_text(offer));
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
