# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Sourced by the scripts in tools/: numbered steps, logged commands, errors.

step_count=0
step_number=0
log_folder=

# The number of steps to come, and the folder of their logs.
begin_steps() { # COUNT LOG_FOLDER
  step_count=$1 log_folder=$2
  mkdir -p "$log_folder"
}

step() { # TITLE
  step_number=$((step_number + 1))
  printf '[%d/%d] %s\n' "$step_number" "$step_count" "$1"
}

fail() { # STATUS MESSAGE
  printf '%s: %s\n' "${0##*/}" "$2" >&2
  exit "$1"
}

# Runs a command with its output in LOG_FOLDER/NAME.log, and shows the end of that when it fails.
logged() { # NAME COMMAND...
  local log=$log_folder/$1.log status=0 more=
  shift
  "$@" >"$log" 2>&1 </dev/null || status=$?
  [[ $status -eq 0 ]] && return
  tail -n 60 "$log" >&2
  [[ $# -le 12 ]] || more=" ..."
  fail "$status" "failed: ${*:1:12}$more (all of its output: $log)"
}
