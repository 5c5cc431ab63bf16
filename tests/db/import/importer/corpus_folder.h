// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/support/temporary_folder.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace phonomime::test {

// A corpus of one speaker in a folder of its own, with four rigid and two lip markers as CSV at
// 50 Hz and xlabel alignments; each test spoils what it is about.
class CorpusFolder {
public:
  CorpusFolder() {
    std::filesystem::create_directory(corpus());
    write("corpus.json", R"({"format": "phonomime-corpus", "version": 1, "name": "small",
      "phoneme_set": "arpabet", "layout": "layout.json", "sentences": "sentences.tsv"})");
    write("layout.json", R"({"format": "phonomime-layout", "version": 1, "kind": "markers",
      "unit": "mm",
      "axes": {"x": "right of the picture", "y": "up", "z": "towards the camera"},
      "groups": [{"name": "r1", "regions": ["rigid"]}, {"name": "r2", "regions": ["rigid"]},
                 {"name": "r3", "regions": ["rigid"]}, {"name": "r4", "regions": ["rigid"]},
                 {"name": "upper", "regions": ["lips"]}, {"name": "lower", "regions": ["lips"]}]})");
    write("a.csv", motion(100, 0.0));
    write("a.lab", alignment(2.0));
    write("b.csv", motion(100, 1.0));
    write("b.lab", alignment(2.0));
    write_table("a\ta.csv\ta.lab\nb\tb.csv\tb.lab\n");
  }

  std::filesystem::path corpus() const { return folder_ / "corpus"; }
  std::filesystem::path database() const { return folder_ / "test.db"; }
  std::filesystem::path outside(std::string_view name) const { return folder_.path() / name; }

  void write(std::string_view name, std::string_view text) const {
    std::ofstream(corpus() / name, std::ios::binary) << text;
  }
  void write_table(std::string_view rows) const {
    write("sentences.tsv", "id\tmotion\talignment\n" + std::string(rows));
  }
  std::string read(std::string_view name) const {
    std::ostringstream text;
    text << std::ifstream(corpus() / name, std::ios::binary).rdbuf();
    return text.str();
  }

  // A head that turns and nods, and a mouth that opens and closes; all `size` times as large.
  static std::string motion(int frames, double phase, double size = 1.0) {
    std::string text = "time";
    for (const char* group : {"r1", "r2", "r3", "r4", "upper", "lower"}) {
      text += fmt::format(",{0}_x,{0}_y,{0}_z", group);
    }
    text += '\n';
    const double local[6][3] = {{-40, 30, 0}, {40, 30, 0},  {0, 60, 5},
                                {0, 10, 20},  {0, -30, 15}, {0, -34, 14}};
    for (int k = 0; k < frames; ++k) {
      const double t = k / 50.0;
      const double yaw = 0.2 * std::sin(t + phase);
      const bool speaks = t >= 0.3 && t < 1.7;
      const double open = speaks ? 5.0 + 5.0 * std::sin(12.0 * t + phase) : 0.02 * std::sin(t);
      text += fmt::format("{:.2f}", t);
      for (int group = 0; group < 6; ++group) {
        const double x = local[group][0];
        const double y = local[group][1] - (group == 5 ? open : 0.0);
        const double z = local[group][2];
        text += fmt::format(
            ",{:.5f},{:.5f},{:.5f}", size * (std::cos(yaw) * x + std::sin(yaw) * z) + 5.0 * t,
            size * y + 2.0 * phase, size * (-std::sin(yaw) * x + std::cos(yaw) * z) + 400.0);
      }
      text += '\n';
    }
    return text;
  }

  // Silence, five phonemes from 0.3 s to 1.7 s, silence up to `end_s`.
  static std::string alignment(double end_s) {
    return fmt::format("#\n0.3 100 sil\n0.55 100 B\n0.8 100 IH1\n1.1 100 N\n1.4 100 AH0\n"
                       "1.7 100 F\n{:.4f} 100 sil\n",
                       end_s);
  }

private:
  TemporaryFolder folder_;
};

} // namespace phonomime::test
