// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <exception>

#include <benchmark/benchmark.h>

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  try {
    if (benchmark::RunSpecifiedBenchmarks() == 0) {
      std::fprintf(stderr, "phonomime_bench: no benchmark has such a name\n");
      return 2;
    }
  } catch (const std::exception& error) { // a wrong answer is not worth timing
    std::fprintf(stderr, "phonomime_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
