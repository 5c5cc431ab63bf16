// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tools/demo/support.h"

#include <array>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <sys/wait.h>

namespace phonomime::demo {

std::vector<Segment> sequence(const std::vector<Sound>& sounds) {
  std::vector<Segment> segments;
  double start_s = 0.0;
  for (const Sound& sound : sounds) {
    segments.push_back({sound.phoneme, start_s, start_s + sound.duration_s});
    start_s += sound.duration_s;
  }
  return segments;
}

std::string as_lab(const std::vector<Segment>& segments) {
  std::string text = "#\n";
  for (const Segment& segment : segments)
    text += fmt::format("{:.4f} 100 {}\n", segment.end_s, segment.phoneme);
  return text;
}

CommandResult run(const std::string& command) {
  FILE* pipe = popen(fmt::format("( {} ) 2>&1", command).c_str(), "r");
  if (pipe == nullptr)
    throw std::runtime_error("no shell");
  CommandResult result;
  std::array<char, 4096> buffer;
  std::size_t count = 0;
  while ((count = fread(buffer.data(), 1, buffer.size(), pipe)) > 0)
    result.output.append(buffer.data(), count);
  const int status = pclose(pipe);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

std::string shell_quoted(std::string_view argument) {
  std::string text = "'";
  for (const char c : argument)
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

bool has_program(const std::string& name) {
  return run("command -v " + name).status == 0;
}

ReadC3d read_with_python(const std::filesystem::path& file) {
  const std::string reader = PHONOMIME_SOURCE_DIR "/tests/support/read_c3d.py";
  const CommandResult result =
      run("python3 -B " + shell_quoted(reader) + " " + shell_quoted(file.string()));
  if (result.status != 0)
    throw std::runtime_error(result.output);
  std::istringstream in(result.output);
  ReadC3d c3d;
  in >> c3d.rate_hz >> c3d.frames >> c3d.markers;
  ReadPoint p;
  while (in >> p.frame >> p.name >> p.xyz_mm[0] >> p.xyz_mm[1] >> p.xyz_mm[2] >> p.residual)
    c3d.points.push_back(p);
  return c3d;
}

} // namespace phonomime::demo
