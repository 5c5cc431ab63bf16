#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# One task of a render farm's job: one shard of a batch (docs/batch.md).
#
#   batch_farm.sh FRAME FRAMES MANIFEST DB [option of phonomime batch]...
#
# FRAME runs from 1 to FRAMES; every queue has a word for it (Deadline: <STARTFRAME>, OpenCue: #IFRAME#).
# $PHONOMIME is the program, where it is not on PATH. $TRIES (3) is how often a task is tried where
# files cannot be read or written, $PAUSE (30) the seconds in between: what is done by then is not done
# again.
set -euo pipefail

if [[ $# -lt 4 ]]; then
  echo "usage: batch_farm.sh FRAME FRAMES MANIFEST DB [option]..." >&2
  exit 2
fi
frame=$1
frames=$2
manifest=$3
database=$4
shift 4

# A farm that kills a task sends SIGTERM to this shell: pass it on, so that the batch stops cleanly.
# The signal may come before the shell knows the program's number.
program=
stopping=
trap 'stopping=yes; [[ -z $program ]] || kill -TERM "$program"' TERM INT

input_or_output=4 # exit status of phonomime
for ((try = 1; ; ++try)); do
  "${PHONOMIME:-phonomime}" batch "$manifest" --db "$database" --shard "$frame/$frames" "$@" &
  program=$!
  [[ -z $stopping ]] || kill -TERM "$program"
  status=0
  wait "$program" || status=$?
  while kill -0 "$program" 2>/dev/null; do # a signal ends the wait before the program ends
    status=0
    wait "$program" || status=$?
  done
  if [[ $status -ne $input_or_output || $try -ge ${TRIES:-3} ]]; then
    exit "$status"
  fi
  echo "batch_farm.sh: try $try of ${TRIES:-3} failed, another one in ${PAUSE:-30} s" >&2
  program=
  sleep "${PAUSE:-30}"
done
