// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/verbs.h"

#include "db/types/file_io.h"
#include "synth/pipeline/explain.h"
#include "tools/cli/terminal.h"

namespace phonomime {

void run_verb(const ExplainArguments& arguments, const CommonArguments& common, const Progress&) {
  const std::string text = read_file(arguments.result);
  // A result is data already: as JSON it is printed as it came, once it has been found to be one.
  const std::string table = explain_result(text, arguments.result.string());
  print(common.json ? text : table);
}

} // namespace phonomime
