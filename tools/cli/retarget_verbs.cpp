// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/retarget_reports.h"
#include "tools/cli/terminal.h"
#include "tools/cli/verbs.h"

#include <nlohmann/json.hpp>

namespace phonomime {

void run_verb(const RetargetListArguments& arguments, const CommonArguments& common,
              const Progress&) {
  const FaceOffer offer = list_face(arguments.options);
  print(common.json ? face_offer_json(offer).dump(1) + "\n" : face_offer_text(offer));
}

void run_verb(const RetargetApplyArguments& arguments, const CommonArguments& common,
              const Progress& progress) {
  const RetargetReport report = apply_to_face(arguments.options, progress);
  clear_progress();
  if (common.json || !common.quiet) {
    print(common.json ? retarget_json(report).dump(1) + "\n" : retarget_text(report));
  }
}

void run_verb(const RetargetReferencesArguments& arguments, const CommonArguments& common,
              const Progress&) {
  const ReferencesReport report = propose_pairs(arguments.options);
  if (common.json || !common.quiet) {
    print(common.json ? references_json(report).dump(1) + "\n" : references_text(report));
  }
}

} // namespace phonomime
