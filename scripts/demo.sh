#!/usr/bin/env bash
# Builds what is missing and shows the map on the recordings that mrpt-common installs:
#   1. one real RGB-D frame,  2. a real 2D laser loop,  3. localisation by MRPT's own
#      pf-localization in a Gaussian mixture map.
# Everything it makes is in build/demo.
set -euo pipefail
cd "$(dirname "$0")/.."
data=/usr/share/mrpt/datasets
out=$PWD/build/demo

scripts/install-deps.sh
[[ -f build/CMakeCache.txt ]] || cmake --preset release >/dev/null
cmake --build --preset release --target hgmm-replay hgmm-map mrpt-hgmm python-core
rm -rf "$out"
mkdir -p "$out"
PATH=$PWD/build/bin:$PATH

section() { printf '\n== %s\n' "$*"; }

section "One RGB-D frame, a fifth of its points held out"
hgmm-replay "$data/tests_rgbd.rawlog" --holdout-points 0.2 --quiet \
    --report "$out/rgbd" --save-map "$out/rgbd.hgmm"
hgmm-map export "$out/rgbd.hgmm" --format png --yaw 0 --pitch 15 -o "$out/rgbd.png"

section "What that map says: along the optical axis, before, near and behind what was seen"
hgmm-map raycast "$out/rgbd.hgmm" --from 0,0,0 --to-direction 1,0,0
hgmm-map query "$out/rgbd.hgmm" 0.8,0,0 1.5,0,0 3.5,0,0
hgmm-map export "$out/rgbd.hgmm" "$out/slice.yaml" --height 0 --resolution 0.02

section "A 2D laser loop, 225 scans on odometry alone, every fifth held out"
hgmm-replay "$data/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog" --split 5 --quiet \
    --report "$out/laser" --save-map "$out/laser.hgmm"
hgmm-map export "$out/laser.hgmm" --format png --pitch 90 -o "$out/laser.png"

section "Pages to open in a browser: both maps in 3D"
hgmm-map view "$out/rgbd.hgmm"
hgmm-map view "$out/laser.hgmm"

section "Stock pf-localization, 40 000 particles spread over 20 x 10 m, in our map"
cd "$out"
if ! LD_PRELOAD=$PWD/../lib/libmrpt-hgmm.so timeout 100 pf-localization \
    ../../share/mrpt-hgmm/config_files/pf-localization.ini </dev/null >pf-localization.log 2>&1; then
    echo "pf-localization failed; its last lines were:" >&2
    tail -5 pf-localization.log >&2
    exit 1
fi
pose=$(grep 'PDF estimation' pf-localization.log | tail -1 | sed 's/.*estimation: \(([^)]*)\).*/\1/')
printf 'estimated final pose  %s\npublished pose        (15.89,-10.00,4.80deg)\n' "$pose"

section "In $out"
ls "$out"
