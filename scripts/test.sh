#!/usr/bin/env bash
# Installs what is missing, builds and runs all tests. Incremental: run it again after a change.
#   scripts/test.sh            the release build
#   scripts/test.sh asan       those of the core and the plugin but the slow ones, built by clang with its
#                              address and undefined-behaviour sanitizers
#   scripts/test.sh tsan       concurrent readers of the core, under the thread sanitizer
# HGMM_DATA_DIR names a folder of recordings; tests that need it say SKIPPED where it is unset.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}

scripts/install-deps.sh "$preset"
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset"
ctest --preset "$preset" -j "$(nproc)"
