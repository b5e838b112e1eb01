#!/usr/bin/env bash
# The table of BENCHMARK.md: imports the recordings of HGMM_DATA_DIR and replays each with default
# options, other maps beside ours. One line per recording and map.
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

# One line for each map of a pretty-printed metrics.json, which has the figures of a map at six
# blanks and those of its levels at ten.
rows() {
    awk -v recording="$1" '
        # What only a probability of occupancy can be asked for.
        function figure(key) { return (key in f) ? sprintf("%.4f", f[key]) : "-" }
        function flush(   kb) {
            if (name == "") return
            kb = ("bytes_serialized" in f ? f["bytes_serialized"] : f["bytes_live"]) / 1000
            if (name ~ /^octomap/) octomap = f["scan_ms_median"]
            line[++n] = sprintf("| `%s` | %s | %.4f | %.4f | %s | %.3f | %s | %s | %.3f / %.3f / %.3f | %.1f | %.2f |",
                recording, name, f["auc_uniform"], f["auc_near"], figure("balanced_accuracy_near"),
                f["tpr_at_fpr_5pct"], figure("brier"), figure("ece"), f["unknown_share_hit"],
                f["unknown_share_free"], f["unknown_share_near"], kb, f["scan_ms_median"])
            ms[n] = f["scan_ms_median"]
            more[n] = sprintf(" %.0f | %s | %.0f |", f["bytes_live"] / 1000,
                ("bytes_serialized" in f) ? sprintf("%.1f", f["bytes_live"] / f["bytes_serialized"]) : "-",
                f["queries_per_s"])
            more[n] = more[n] (("components_surface" in f) ? sprintf(" %d / %d | %.2f | %.3f | %.2f / %.2f | %.2f |",
                f["components_surface"], f["components_free"], f["loglik_hit"], f["f1_5cm"],
                100 * f["unseen_called_free_behind_hits"], 100 * f["unseen_called_free_in_box"],
                100 * f["seen_called_unknown"]) : " - | - | - | - | - |")
            delete f
        }
        /^      "name":/ { flush(); name = $2; gsub(/[",]/, "", name) }
        /^      "[a-z0-9_]+": [-0-9.e+]+,?$/ { key = $1; gsub(/[":]/, "", key); f[key] = $2 + 0 }
        END {
            flush()
            for (i = 1; i <= n; ++i)
                printf("%s %s |%s\n", line[i], (octomap > 0 ? sprintf("%.2f", ms[i] / octomap) : "-"), more[i])
        }' "$out/$1/metrics.json"
}

replay() {
    local name=$1
    shift
    hgmm-replay "$out/$name.rawlog" --poses "$out/$name.tum" --threads 1 --quiet \
        --report "$out/$name" "$@" >"$out/$name.log"
    rows "$name"
}

import rgbd_kitchen 7scenes "$data/rgbd_kitchen"
import livox_building pcd "$data/livox_building/scans" \
    --poses "$data/livox_building/poses_tum.txt" --sensor-pose 0.0417,0.0233,-0.0284,0,0,0
import lidar16_room_sim pcd "$data/lidar16_room_sim" --poses "$data/lidar16_room_sim/poses_tum.txt"
import sim_structured pcd "$data/la3dm_sim/sim_structured" --world-frame
import sim_unstructured pcd "$data/la3dm_sim/sim_unstructured" --world-frame

echo '| recording | map | AUC uniform | AUC near | balanced accuracy | TPR at 5 % FPR | Brier | ECE | unknown: hits / uniform / near | KB | ms/scan | ratio to OctoMap | heap KB | heap / saved | queries/s | components surface / free | log-likelihood | F1 at 5 cm | unseen called free behind hits / in box % | seen called unknown % |'
echo '|'"$(printf ' --- |%.0s' {1..20})"
replay rgbd_kitchen --split 10 --baselines octomap,grid3d,ndt-om,gpoctomap,ndt,nn
replay livox_building --split 5 --baselines octomap,grid3d,ndt-om,gpoctomap,ndt,nn
sim=(--holdout-points 0.2 --free-band 0,0.2 --baselines octomap:0.15,ndt-om:0.2,gpoctomap:0.15,nn)
replay sim_structured "${sim[@]}"
replay sim_unstructured "${sim[@]}"
replay lidar16_room_sim --split 4 --baselines octomap:0.1
