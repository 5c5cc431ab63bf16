// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/synth.h"

#include <filesystem>
#include <vector>

namespace phonomime {

// What several verbs ask of their options. All throw UsageError.

void check_range(const char* option, double value, double least, double most);

// One file twice would be written twice and counted twice. Written by renaming, two names of one
// folder are two files, whatever links there were.
void check_outputs_differ(const std::vector<std::filesystem::path>& outputs);

// How a transcript becomes motion: smoothing, paths to blend, threads.
void check_motion_options(const SynthOptions& options);

} // namespace phonomime
