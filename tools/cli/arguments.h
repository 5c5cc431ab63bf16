// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/motion_database.h"
#include "tools/app/batch.h"
#include "tools/app/evaluate.h"
#include "tools/app/import_corpus.h"
#include "tools/app/stream.h"
#include "tools/app/synth.h"
#include "tools/app/tune.h"
#include "tools/cli/curation_arguments.h"
#include "tools/cli/map_arguments.h"
#include "tools/cli/retarget_arguments.h"
#include "tools/cli/style_arguments.h"

#include <filesystem>
#include <string>
#include <variant>

namespace phonomime {

// What the words of a call ask for. One struct for each verb, filled by parse_arguments.
struct CommonArguments {
  bool json = false;
  bool quiet = false;
};

struct ImportArguments {
  ImportOptions options;
};

struct InfoArguments {
  std::filesystem::path database;
};

struct NodesArguments {
  std::filesystem::path database;
  NodeFilter filter;
  long limit = 0; // 0 = all
};

struct SynthArguments {
  SynthOptions options;
};

// synth --stream
struct StreamArguments {
  StreamOptions options;
};

struct BatchArguments {
  BatchOptions options;
};

struct EvaluateArguments {
  EvaluateOptions options;
};

struct TuneArguments {
  TuneOptions options;
};

struct ExplainArguments {
  std::filesystem::path result;
};

// What `--help` and `--version` print.
struct PrintArguments {
  std::string text;
};

struct Arguments {
  CommonArguments common;
  std::variant<PrintArguments, ImportArguments, InfoArguments, NodesArguments, SuspectsArguments,
               CurateArguments, JournalArguments, SynthArguments, StreamArguments,
               MapBuildArguments, MapShowArguments, MapImageArguments, MapPickArguments,
               MapQualityArguments, RecommendArguments, RetargetListArguments,
               RetargetApplyArguments, RetargetReferencesArguments, ChooseKeyshapesArguments,
               ApplyRigArguments, StyleTrainArguments, StyleShowArguments, StyleApplyArguments,
               BatchArguments, EvaluateArguments, TuneArguments, ExplainArguments>
      verb;
};

// Throws UsageError.
Arguments parse_arguments(int argc, const char* const* argv);

} // namespace phonomime
