// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/cli/arguments.h"

#include "db/types/progress.h"

namespace phonomime {

// Each does one verb: data to stdout, messages to stderr. They throw phonomime errors.
void run_verb(const ImportArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const InfoArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const NodesArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const SuspectsArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const CurateArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const JournalArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const SynthArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const StreamArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const BatchArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const EvaluateArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const TuneArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const MapBuildArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const MapShowArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const MapImageArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const MapPickArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const MapQualityArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const RecommendArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const RetargetApplyArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const RetargetReferencesArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const RetargetListArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const ChooseKeyshapesArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const ApplyRigArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const StyleTrainArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const StyleShowArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const StyleApplyArguments& arguments, const CommonArguments& common,
              const Progress& progress);
void run_verb(const ExplainArguments& arguments, const CommonArguments& common,
              const Progress& progress);

} // namespace phonomime
