// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace phonomime {

// Sound that every browser plays: a WAV file of 16-bit samples.
struct WavAudio {
  std::string bytes;
  double duration_s = 0.0;
};

// Any sound file that libsndfile reads (WAV, FLAC, AIFF, Ogg ...), from memory. A 16-bit WAV stays
// as it is. `where` names it in errors. Throws InputError.
WavAudio to_wav(std::string bytes, std::string_view where);

// The same from a file. Throws InputError and IoError.
WavAudio read_audio(const std::filesystem::path& path);

} // namespace phonomime
