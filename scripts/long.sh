#!/usr/bin/env bash
# What is too slow for .ci/run, in stages. Run it before an issue closes.
#   scripts/long.sh     HGMM_DATA_DIR names the recordings, ../shared/data if unset
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/stages.sh

# Sanitized, what .ci/run leaves out: evaluation, programs, and all that is labelled slow.
sanitizedRest() {
    cmake --preset asan >/dev/null
    cmake --build --preset asan-all
    env -u HGMM_DATA_DIR ctest --preset asan-all -j "$(nproc)"
}

# Races that show in one of many runs.
racesAgain() {
    cmake --preset tsan >/dev/null
    cmake --build --preset tsan
    ctest --preset tsan --repeat until-fail:20
}

# The core's tests as they are built for changing code, and each in a process and order of its own.
coreShuffled() {
    cmake --preset debug >/dev/null
    cmake --build --preset debug --target test-hgmm test-threads
    build-debug/tests/test-hgmm --gtest_brief=1 --gtest_shuffle
    build-debug/tests/test-threads --gtest_brief=1 --gtest_shuffle
}

# The viewer and the report, clicked through in a headless browser.
pages() {
    scripts/test.sh >/dev/null
    ctest --preset release -C Browser -R python.browser
}

# A wheel of the Python package stands alone: it reads a saved map where nothing else of this tree is.
wheel() {
    local work
    work=$(mktemp -d)
    (cd python && /usr/bin/python3 -m build --wheel --no-isolation --outdir "$work")
    /usr/bin/python3 -m zipfile -e "$work"/hgmm-*.whl "$work/package"
    cp tests/mrpt-hgmm/data/map_model_v4.hgmm "$work"
    (cd "$work" && ! ldd package/hgmm/_core*.so | grep -E 'not found|mrpt' &&
        PYTHONPATH=package /usr/bin/python3 -c "import hgmm; print(hgmm.Map.load('map_model_v4.hgmm'))")
    rm -rf "$work"
}

# 10^7 points in one scan: what they cost.
largeScans() {
    cmake --preset release >/dev/null
    cmake --build --preset release --target test-hgmm
    HGMM_LARGE_SCAN=10000000 build/tests/test-hgmm --gtest_filter='LargeScan.CostsLittleForEachPoint'
}

stage 'packages' scripts/install-deps.sh asan
stage 'packages of the browser' scripts/install-deps.sh browser
stage 'equality sees one ulp' scripts/equality.sh --self-test
stage 'core in debug, shuffled' coreShuffled
stage 'scans of 10^7 points' largeScans
stage 'clang-tidy of the core' scripts/tidy.sh --core
stage 'coverage of the core' scripts/coverage.sh
stage 'sanitized, everything' sanitizedRest
stage 'races, 20 times' racesAgain
stage 'pages in a browser' pages
stage 'wheel' wheel
