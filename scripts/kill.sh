#!/usr/bin/env bash
# Kills hgmm-replay, hgmm-map and hgmm-import at random moments, N times each, and looks whether the old or
# the new file is there, whole, and whether the next run cleans up.
#   scripts/kill.sh [N]    200 if not given; needs the build of scripts/test.sh
set -euo pipefail
cd "$(dirname "$0")/.."
HGMM_KILLS=${1:-200} build/tests/test-apps --gtest_filter='Kill.*'
