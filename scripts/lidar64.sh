#!/usr/bin/env bash
# Inserts scans of a simulated lidar of 64 rings, in a hall and outdoors (scripts/simulate_lidar64.py),
# into our map and into OctoMap: milliseconds of a scan in one thread, median and worst, which is the first.
#   scripts/lidar64.sh [SCANS]      default: 30
# REPLAY names another hgmm-replay, to compare builds. Needs a build. Recordings go to build/lidar64.
set -euo pipefail
cd "$(dirname "$0")/.."
scans=${1:-30}
out=$PWD/build/lidar64
replay=${REPLAY:-build/bin/hgmm-replay}
mkdir -p "$out"

echo '| scene | points | map | median ms | worst ms |'
echo '| --- | --- | --- | --- | --- |'
for scene in hall outdoors; do
    log=$out/$scene-$scans
    if [[ ! -f $log.rawlog ]]; then
        /usr/bin/python3 scripts/simulate_lidar64.py $scene "$log" --scans "$scans"
        build/bin/hgmm-import pcd "$log" --poses "$log/poses.txt" -o "$log.rawlog" \
            --poses-out "$log.tum" >/dev/null
    fi
    "$replay" "$log.rawlog" --poses "$log.tum" --threads 1 --quiet --split 10 --baselines octomap:0.2 \
        --report "$log" >"$log.log" 2>&1
    awk -v scene=$scene '
        /"points_per_scan":/ { points = $2 + 0 }
        /^      "name":/ { name = $2; gsub(/[",]/, "", name) }
        /^      "scan_ms_median":/ { median = $2 }
        /^      "scan_ms_worst":/ { printf("| %s | %d | %s | %.1f | %.1f |\n", scene, points, name, median, $2) }
        ' "$log/metrics.json"
done
