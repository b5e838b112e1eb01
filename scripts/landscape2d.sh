#!/usr/bin/env bash
# Where the likelihood of a 2D laser's scans has its maximum, and whether hill climbing leads
# there: studies landscape and landscape-local on the Telecom loop, every fourth scan tested, with
# the poses that stock icp-slam, on its points map, gives it: scans enter that map after METRES,
# DEGREES, and poses are corrected after half of them.
#   scripts/landscape2d.sh [METRES DEGREES]        default: 0.1 2
# Needs a build. Everything it makes is in build/landscape2d.
set -euo pipefail
cd "$(dirname "$0")/.."
metres=${1:-0.1}
degrees=${2:-2}
half() { awk -v value="$1" 'BEGIN { print value / 2 }'; }
out=$PWD/build/landscape2d
rm -rf "$out"
mkdir -p "$out"
sed "s/^hgmmMap_count .*/hgmmMap_count = 0/
     s/^insertionLinDistance .*/insertionLinDistance = $metres/
     s/^insertionAngDistance .*/insertionAngDistance = $degrees/
     s/^localizationLinDistance .*/localizationLinDistance = $(half "$metres")/
     s/^localizationAngDistance .*/localizationAngDistance = $(half "$degrees")/
     s/^corresponding_points_decimation .*/corresponding_points_decimation = 1/" \
    share/mrpt-hgmm/config_files/icp-slam.ini >"$out/icp-slam.ini"
PATH=$PWD/build/bin:$PATH
cd "$out"
icp-slam icp-slam.ini </dev/null >log 2>&1
hgmm-import simplemap LOG_ICP-SLAM/_finalmap_.simplemap -o telecom.rawlog --poses-out telecom.tum
for study in landscape landscape-local; do
    hgmm-replay telecom.rawlog --poses telecom.tum --split 4 --study "$study" --quiet
done
