// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tools/demo/segments.h"

namespace phonomime::demo {

// Segments one after the other from time 0.
struct Sound {
  std::string phoneme;
  double duration_s;
};
std::vector<Segment> sequence(const std::vector<Sound>& sounds);

// The same as Festival writes them.
std::string as_lab(const std::vector<Segment>& segments);

struct CommandResult {
  int status = -1;
  std::string output; // stdout and stderr
};

// Runs a shell command.
CommandResult run(const std::string& command);

// An argument for run(), quoted for the shell.
std::string shell_quoted(std::string_view argument);

// A point as tests/support/read_c3d.py reads it.
struct ReadPoint {
  long frame = 0;
  std::string name;
  double xyz_mm[3] = {0.0, 0.0, 0.0};
  double residual = 0.0;
};
struct ReadC3d {
  double rate_hz = 0.0;
  long frames = 0;
  long markers = 0;
  std::vector<ReadPoint> points;
};

bool has_program(const std::string& name);

// Throws std::runtime_error with the reader's words where it refuses the file.
ReadC3d read_with_python(const std::filesystem::path& file);

} // namespace phonomime::demo
