// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace phonomime {

// What a batch knows of a row that it has done: which fingerprint its outputs were made from, and
// what they were. Each row has a record of its own, a small file in the folder `.phonomime-batch`
// beside its first output, so that batches and shards at work at the same time never write the same
// record, and a row is known to be done whoever did it (docs/batch.md).

// Of the row with these outputs, of which there is at least one.
std::filesystem::path record_path(std::span<const std::filesystem::path> outputs);

// Whether these outputs were made from this fingerprint and are still what they were. A record that
// is missing or damaged says no.
bool is_done(std::span<const std::filesystem::path> outputs, const std::string& fingerprint);

// Records the outputs as they lie on disk. Throws IoError and InputError as read_file does.
void write_record(std::span<const std::filesystem::path> outputs, const std::string& fingerprint);

// Removes what killed batches have left beside these outputs: unfinished files, which OutputFiles
// writes beside its targets. What cannot be removed stays.
void remove_unfinished(std::span<const std::filesystem::path> outputs);

} // namespace phonomime
