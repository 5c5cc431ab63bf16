// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/alignment.h"
#include "db/types/motion.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace phonomime {

// Formats follow the suffix, and where that is shared or unknown, the content.
struct AlignmentOptions {
  std::string tier;  // TextGrid: the phone tier's name; empty = found by name
};

// .lab (Festival/xlabel, or HTK where its rows are `start end label`), .TextGrid (long, short;
// UTF-8, UTF-16), .htk/.mlf-free HTK label files. Throws InputError and IoError.
Alignment read_alignment(const std::filesystem::path& path, const AlignmentOptions& options = {});

// .c3d, marker .csv, Live Link Face .csv. Throws InputError and IoError.
MotionClip read_motion(const std::filesystem::path& path);

// The same from bytes already in memory; `where` names them in errors.
Alignment parse_xlabel(std::string_view text, std::string_view where);
Alignment parse_htk_label(std::string_view text, std::string_view where);
Alignment parse_textgrid(std::string_view bytes, std::string_view where, std::string_view tier = {});
MotionClip parse_c3d(std::string_view bytes, std::string_view where);
MotionClip parse_marker_csv(std::string_view text, std::string_view where);
MotionClip parse_live_link_csv(std::string_view text, std::string_view where);

}  // namespace phonomime
