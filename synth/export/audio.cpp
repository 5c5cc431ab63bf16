// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/audio.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include <sndfile.h>

namespace phonomime {
namespace {

constexpr sf_count_t kMostSamples = sf_count_t{1} << 29;

// A file in memory as libsndfile wants it.
struct MemoryFile {
  std::string bytes;
  sf_count_t position = 0;

  sf_count_t size() const { return static_cast<sf_count_t>(bytes.size()); }

  static MemoryFile& of(void* user) { return *static_cast<MemoryFile*>(user); }

  static SF_VIRTUAL_IO io() {
    SF_VIRTUAL_IO io{};
    io.get_filelen = [](void* user) { return of(user).size(); };
    io.tell = [](void* user) { return of(user).position; };
    io.seek = [](sf_count_t offset, int whence, void* user) {
      MemoryFile& file = of(user);
      const sf_count_t base = whence == SEEK_SET   ? 0
                              : whence == SEEK_CUR ? file.position
                                                   : file.size();
      file.position = std::clamp<sf_count_t>(base + offset, 0, file.size());
      return file.position;
    };
    io.read = [](void* to, sf_count_t count, void* user) {
      MemoryFile& file = of(user);
      const sf_count_t take = std::clamp<sf_count_t>(file.size() - file.position, 0, count);
      std::memcpy(to, file.bytes.data() + file.position, static_cast<std::size_t>(take));
      file.position += take;
      return take;
    };
    io.write = [](const void* from, sf_count_t count, void* user) {
      MemoryFile& file = of(user);
      file.bytes.resize(
          std::max(file.bytes.size(), static_cast<std::size_t>(file.position + count)));
      std::memcpy(file.bytes.data() + file.position, from, static_cast<std::size_t>(count));
      file.position += count;
      return count;
    };
    return io;
  }
};

using SoundFile = std::unique_ptr<SNDFILE, decltype(&sf_close)>;

SoundFile open(MemoryFile& memory, int mode, SF_INFO& info) {
  SF_VIRTUAL_IO io = MemoryFile::io();
  return {sf_open_virtual(&io, mode, &info, &memory), sf_close};
}

std::string encode(const std::vector<float>& samples, const SF_INFO& source) {
  MemoryFile memory;
  SF_INFO info{};
  info.samplerate = source.samplerate;
  info.channels = source.channels;
  info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
  SoundFile file = open(memory, SFM_WRITE, info);
  if (file == nullptr) {
    throw InternalError(
        {.what = std::string("sound could not be encoded: ") + sf_strerror(nullptr)});
  }
  sf_command(file.get(), SFC_SET_CLIPPING, nullptr, SF_TRUE);
  sf_write_float(file.get(), samples.data(), static_cast<sf_count_t>(samples.size()));
  file.reset();
  return std::move(memory.bytes);
}

} // namespace

WavAudio to_wav(std::string bytes, std::string_view where) {
  MemoryFile memory{.bytes = std::move(bytes), .position = 0};
  SF_INFO info{};
  SoundFile file = open(memory, SFM_READ, info);
  if (file == nullptr || info.frames <= 0 || info.channels <= 0 || info.samplerate <= 0) {
    throw InputError({.where = std::string(where),
                      .what = "this is not a sound file that can be read",
                      .expected = "WAV, FLAC, AIFF or Ogg",
                      .got = file == nullptr ? sf_strerror(nullptr) : "no sample"});
  }
  if (info.frames > kMostSamples / info.channels) {
    throw InputError({.where = std::string(where), .what = "the sound is too long"});
  }
  WavAudio audio;
  constexpr int kWav16 = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
  if ((info.format & (SF_FORMAT_TYPEMASK | SF_FORMAT_SUBMASK)) == kWav16) {
    audio.duration_s = static_cast<double>(info.frames) / info.samplerate;
    file.reset();
    audio.bytes = std::move(memory.bytes);
    return audio;
  }
  std::vector<float> samples;
  std::vector<float> block(static_cast<std::size_t>(info.channels) * 4096);
  for (sf_count_t got = 1; got > 0;) {
    got = sf_readf_float(file.get(), block.data(), 4096);
    samples.insert(samples.end(), block.begin(),
                   block.begin() + std::max<sf_count_t>(got, 0) * info.channels);
    if (samples.size() > static_cast<std::size_t>(kMostSamples)) {
      throw InputError({.where = std::string(where), .what = "the sound is too long"});
    }
  }
  audio.duration_s = static_cast<double>(samples.size()) / info.channels / info.samplerate;
  audio.bytes = encode(samples, info);
  return audio;
}

WavAudio read_audio(const std::filesystem::path& path) {
  return to_wav(read_file(path), path.string());
}

} // namespace phonomime
