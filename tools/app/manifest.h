// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/synth.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// One synthesis of a batch.
struct ManifestRow {
  long line = 0;
  std::string id;
  SynthOptions options;
};

// The rows of a manifest's text (corpora_schema/manifest.md). `path` names the file in errors, and
// its folder is what relative paths start from; `defaults` holds for every cell that is empty.
// Throws UsageError for defaults that cannot be right, InputError, with the line, for all that can
// be said of a row without opening its files: an unknown, repeated or missing column, too many
// fields, an empty transcript, no output or one of no known kind, an fps that is no number or out
// of range, a face that is missing, a repeated id, an output that another row writes or that some
// row reads; and for a manifest without rows.
std::vector<ManifestRow> parse_manifest(std::string_view text, const std::filesystem::path& path,
                                        const SynthOptions& defaults);

} // namespace phonomime
