#!/usr/bin/env bash
# What hgmm-slam makes of simulated recordings whose truth is known: closures between rooms that look
# alike, two loops, a corridor without features, a robot that is carried away, gaps, wrong odometry, a
# tunnel. Prints tables; build/slam/studies.log has each run.
#   scripts/slam_studies.sh [planar|rings [RUNS]]      default: both; RUNS of each kind, by default those of
# bench-slam-studies (1000 pairs, 20 runs, 2 km), which take hours for the rings. Needs a build.
set -euo pipefail
cd "$(dirname "$0")/.."
sensors=(planar rings)
[[ $# -eq 0 ]] || sensors=("$1")
mkdir -p build/slam
for sensor in "${sensors[@]}"; do
    for study in pairs rooms loops corridor disturbed tunnel; do
        echo "$study, $sensor"
        build/bin/bench-slam-studies $study "$sensor" ${2:+"$2"} 2>>build/slam/studies.log
    done
done
