// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/audio.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "tests/support/shared_data.h"
#include "tests/synth/retarget/glb_bytes.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::append_bytes;

// A WAV file by its specification: `format` 1 = integers, 3 = floats.
std::string wav(std::uint16_t format, std::uint16_t bits, std::uint16_t channels,
                const std::string& samples) {
  std::string bytes = "RIFF";
  append_bytes(bytes, static_cast<std::uint32_t>(36 + samples.size()));
  bytes += "WAVEfmt ";
  append_bytes(bytes, std::uint32_t{16});
  append_bytes(bytes, format);
  append_bytes(bytes, channels);
  append_bytes(bytes, std::uint32_t{8000});
  append_bytes(bytes, static_cast<std::uint32_t>(8000 * channels * bits / 8));
  append_bytes(bytes, static_cast<std::uint16_t>(channels * bits / 8));
  append_bytes(bytes, bits);
  bytes += "data";
  append_bytes(bytes, static_cast<std::uint32_t>(samples.size()));
  return bytes + samples;
}

TEST(Audio, LeavesA16BitWavAsItIs) {
  std::string samples;
  for (int i = 0; i < 4000; ++i) {
    append_bytes(samples, static_cast<std::int16_t>(i * 7));
  }
  const std::string bytes = wav(1, 16, 2, samples);
  const WavAudio audio = to_wav(bytes, "a.wav");
  EXPECT_EQ(audio.bytes, bytes);
  EXPECT_DOUBLE_EQ(audio.duration_s, 0.25);
}

TEST(Audio, Makes16BitSamplesOfFloats) {
  std::string samples;
  for (int i = 0; i < 800; ++i) {
    append_bytes(samples, static_cast<float>(1.5 * std::sin(0.05 * i)));
  }
  const WavAudio audio = to_wav(wav(3, 32, 1, samples), "a.wav");
  EXPECT_DOUBLE_EQ(audio.duration_s, 0.1);
  ASSERT_EQ(audio.bytes.size(), 44u + 1600u);
  for (int i = 0; i < 800; ++i) {
    std::int16_t value = 0;
    std::memcpy(&value, audio.bytes.data() + 44 + 2 * i, 2);
    const double expected = std::clamp(1.5 * std::sin(0.05 * i), -1.0, 1.0);
    EXPECT_NEAR(value / 32768.0, expected, 1e-4) << "clipped, not wrapped";
  }
}

TEST(Audio, RefusesWhatIsNoSound) {
  for (const std::string& bytes :
       {std::string(), std::string("RIFF"), std::string(2000, 'x'), wav(1, 16, 1, "")}) {
    try {
      to_wav(bytes, "a.wav");
      FAIL() << "no error";
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("a.wav: this is not a sound file"))
          << error.what();
    }
  }
}

TEST(Audio, SurvivesDamage) {
  const std::string good = wav(3, 32, 1, std::string(400, '\x20'));
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    std::string bad = good;
    for (int k = 0; k < 3; ++k) {
      bad[random() % 60] = static_cast<char>(random() % 256);
    }
    try {
      EXPECT_FALSE(to_wav(bad, "bad.wav").bytes.empty());
    } catch (const InputError&) {
    }
  }
}

TEST(Audio, ReadsARecording) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  const auto path = data / "grid_s1/audio/bbaf2n.wav";
  const WavAudio audio = read_audio(path);
  EXPECT_NEAR(audio.duration_s, 3.0, 0.1);
  EXPECT_EQ(audio.bytes, read_file(path));
}

} // namespace
} // namespace phonomime
