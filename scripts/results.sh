#!/usr/bin/env bash
# The README's table: imports the recordings of HGMM_DATA_DIR and replays each with default options.
#   HGMM_DATA_DIR=../shared/data scripts/results.sh
# Needs a build (scripts/test.sh makes one). Rawlogs and reports go to build/results.
set -euo pipefail
cd "$(dirname "$0")/.."
: "${HGMM_DATA_DIR:?names no folder of recordings}"
data=$(cd "$HGMM_DATA_DIR" && pwd)
out=build/results
mkdir -p "$out"
PATH=$PWD/build/bin:$PATH

import() {
    local name=$1
    shift
    [[ -f $out/$name.rawlog ]] ||
        hgmm-import "$@" -o "$out/$name.rawlog" --poses-out "$out/$name.tum" >"$out/$name.import.log"
}

# The first number of a key of the pretty-printed metrics.json.
figure() { sed -n "s/^ *\"$2\": \([-0-9.e]*\),\{0,1\}\$/\1/p" "$out/$1/metrics.json" | head -1; }

# Components of all levels, base first.
levels() { sed -n 's/^ *"components": \([0-9]*\),$/\1/p' "$out/$1/metrics.json" | paste -sd' '; }

row() {
    local name=$1
    shift
    hgmm-replay "$out/$name.rawlog" --poses "$out/$name.tum" --threads 1 --quiet \
        --report "$out/$name" "$@" >"$out/$name.log"
    awk -v name="$name" -v how="$*" -v levels="$(levels "$name")" \
        -v kb="$(figure "$name" bytes_serialized)" -v ms="$(figure "$name" scan_ms_median)" \
        -v first="$(figure "$name" scan_ms_first_tenth)" \
        -v last="$(figure "$name" scan_ms_last_tenth)" -v nat="$(figure "$name" loglik_hit)" \
        -v f1="$(figure "$name" f1_5cm)" -v accuracy="$(figure "$name" accuracy_m)" \
        -v completeness="$(figure "$name" completeness_m)" \
        'BEGIN { printf "| `%s` | `%s` | %s | %.1f | %.1f (%.1f, %.1f) | %.2f | %.3f | %.1f / %.1f |\n",
                 name, how, levels, kb / 1024, ms, first, last, nat, f1,
                 100 * accuracy, 100 * completeness }'
}

import rgbd_kitchen 7scenes "$data/rgbd_kitchen"
import livox_building pcd "$data/livox_building/scans" \
    --poses "$data/livox_building/poses_tum.txt" --sensor-pose 0.0417,0.0233,-0.0284,0,0,0
import lidar16_room_sim pcd "$data/lidar16_room_sim" --poses "$data/lidar16_room_sim/poses_tum.txt"
import sim_structured pcd "$data/la3dm_sim/sim_structured" --world-frame
import sim_unstructured pcd "$data/la3dm_sim/sim_unstructured" --world-frame

echo '| recording | test points | components per level | KB | ms/scan, median (first, last tenth) | log-likelihood | F1 at 5 cm | accuracy / completeness [cm] |'
echo '| --- | --- | --- | --- | --- | --- | --- | --- |'
row rgbd_kitchen --split 10
row livox_building --split 5
row lidar16_room_sim --split 4
row sim_structured --holdout-points 0.2
row sim_unstructured --holdout-points 0.2
