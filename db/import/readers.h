// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/alignment.h"
#include "db/types/motion.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace phonomime {

// Every reader throws InputError for bytes that it cannot take, with the file and the line (or, in
// C3D, the place) in the message, and IoError where the file cannot be read. None needs more memory
// than a small multiple of the file's size.

struct AlignmentOptions {
  std::string tier; // TextGrid: the phone tier's name; empty = found by name
};

// An alignment file, its format by the suffix (.lab, .htk, .TextGrid), and where that is shared or
// unknown by the content. A .lab is Festival/xlabel where its header ends with a line `#`, else
// HTK.
Alignment read_alignment(const std::filesystem::path& path, const AlignmentOptions& options = {});

// A motion file: .c3d or .csv, or what its content says. A .csv is a Live Link Face take where its
// first column is Timecode, a marker or weight table where it is time.
MotionClip read_motion(const std::filesystem::path& path);

// The same from bytes already in memory; `where` names them in errors. All text is UTF-8, or UTF-16
// with a byte order mark. A row that ends before it begins is an error, as are rows that overlap.
// Gaps between rows are allowed (silence); of rows without a duration to_phonemes judges.

// Festival/xlabel: header lines, a line `#`, then rows `end_time number label`. The first row
// starts at 0; a row without a label has the label "" (silence); what follows the separator (`;`
// unless the header names another) is not read.
Alignment parse_xlabel(std::string_view text, std::string_view where);

// HTK: rows `start end label ...`, times as integers in 100 ns. Times with a decimal point and
// below 100 000 are seconds, as audio editors write them. Scores and further levels behind the
// label are not read. Master label files (MLF) and alternatives (`///`) are refused.
Alignment parse_htk_label(std::string_view text, std::string_view where);

// Praat TextGrid as text, long or short form. `tier` names the phone tier (as written, else in any
// case); empty = the one called phones, phonemes, segments or MAU, or `NAME - phones`. The rows are
// that tier's intervals, those without a label too.
Alignment parse_textgrid(std::string_view bytes, std::string_view where,
                         std::string_view tier = {});

// C3D of any processor type (Intel, DEC, MIPS), scaled integers or floats. Points with a negative
// residual or a coordinate that is not finite are missing. Point k (from 1) without a label is
// called `*k`; a label given twice is an error. start_s = (first frame - 1) / rate; unit_mm is 0
// where POINT:UNITS is not mm, cm or m. Analog data is skipped.
MotionClip parse_c3d(std::string_view bytes, std::string_view where);

// `time,<group>_x,<group>_y,<group>_z,...` in seconds and mm, or `time,<name>,...` for weights. A
// field that is empty or nan is missing, and with it its whole marker. The rate is deduced from the
// times: each step must be within a tenth of a frame (or 1 ms, where that is more) of the others.
MotionClip parse_marker_csv(std::string_view text, std::string_view where);

// Live Link Face: Timecode, BlendShapeCount (in either spelling), then the 52 ARKit shapes and the
// 9 angles of head and eyes, or some of them, named in any case; groups carry Epic's spelling. A
// timecode is HH:MM:SS:FF.mmm, FF in 60ths of a second in 30 fps takes too (in other ticks only
// where the seconds' changes prove it). Frames stand on a uniform grid at the measured rate (at the
// nominal one where the timecodes agree with it to their last digit); a dropped frame and a row
// with a count of 0 are missing. start_s is 0: the timecode is a time of day.
MotionClip parse_live_link_csv(std::string_view text, std::string_view where);

} // namespace phonomime
