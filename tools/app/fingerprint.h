// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "tools/app/synth.h"

#include <filesystem>
#include <map>
#include <mutex>
#include <string>

namespace phonomime {

// What a result depends on, as 64 hexadecimal digits (SHA-256): while the fingerprint is the same,
// the result is the same.

// Of files' content. May be asked from several threads. What a file was when it was first
// asked for, it stays.
class FileFingerprints {
public:
  // Throws IoError and InputError as read_file does.
  std::string of(const std::filesystem::path& file);

private:
  std::mutex mutex_;
  std::map<std::filesystem::path, std::string> known_;
};

// Of one speaker's recordings as a synthesis sees them. The hour of an import, or where the
// database lies, changes nothing.
std::string fingerprint(const MotionTable& table);

// Of a synthesis: the program's version, the recordings (`table`: their fingerprint), every option
// but threads, and the content of every file that is read. Where a file lies counts only where it
// gets into a result: the transcript's name (the title), the constraints' path (warnings). Throws
// IoError and InputError for a file that is not there.
std::string fingerprint(const SynthOptions& options, const std::string& table,
                        FileFingerprints& files);

} // namespace phonomime
