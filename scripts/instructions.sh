#!/usr/bin/env bash
# Counts the instructions of Map::insert and of its stages by callgrind, so that a busy machine does
# not blur progress: one line for all, then those of at least 2 % (inclusive).
#   scripts/instructions.sh LOG.rawlog POSES.tum [SCANS]     default: the first 12 scans
# REPLAY names another hgmm-replay, to compare builds. Needs valgrind and a build.
set -euo pipefail
replay=${REPLAY:-$(dirname "$0")/../build/bin/hgmm-replay}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
valgrind --tool=callgrind --callgrind-out-file="$work/out" \
    --toggle-collect='hgmm::Map::insert(hgmm::Scan const&)' \
    "$replay" "$1" --poses "$2" --threads 1 --quiet --to $((${3:-12} - 1)) >"$work/log" 2>&1 ||
    { tail -n 5 "$work/log" >&2; exit 1; }
callgrind_annotate --inclusive=yes --threshold=100 "$work/out" |
    sed -E 's/\(anonymous namespace\):://g' | sed -nE 's/^ *([0-9,]+) \(([ 0-9.]+)%\)  .*:(hgmm::[^(<]*).*/\1 \2 \3/p' |
    awk '$2 >= 2 && !seen[$3]++ { gsub(",", "", $1); printf("%9.1f million  %5.1f %%  %s\n", $1 / 1e6, $2, $3) }'
