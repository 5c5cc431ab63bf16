# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Sourced by the scripts in tools/: configures and builds a preset in build/PRESET. Needs steps.sh,
# and the repository as working folder.

# Objects are shared among clones of the repository.
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
# What ccache asks of those who precompile headers.
export CCACHE_SLOPPINESS=pch_defines,time_macros

# Builds targets of a preset, everything where none is named.
build_preset() { # PRESET [TARGET...]
  local preset=$1 target targets=()
  shift
  for target in "$@"; do
    targets+=(--target "$target")
  done
  logged "$preset-configure" cmake --preset "$preset"
  logged "$preset-build" cmake --build --preset "$preset" --parallel "$(nproc)" "${targets[@]}"
}
