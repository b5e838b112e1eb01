#!/usr/bin/env bash
# Localises a handheld 3D lidar in all six dimensions with stock pf-localization: the map holds
# four of five scans of livox_building, the others are localised in it, with noisy 3D odometry,
# from a start spread of +-2 m, +-10 deg.
#   HGMM_DATA_DIR=../shared/data scripts/localisation3d.sh [RUNS]        default: 5 runs
# A run succeeds if, after the first 20 updates, its median error is below 0.3 m and 2 deg.
# Needs a build. Everything it makes is in build/localisation3d.
set -euo pipefail
cd "$(dirname "$0")/.."
: "${HGMM_DATA_DIR:?names no folder of recordings}"
data=$(cd "$HGMM_DATA_DIR" && pwd)/livox_building
runs=${1:-5}
out=$PWD/build/localisation3d
config=$PWD/share/mrpt-hgmm/config_files/pf-localization-3d.ini
sensor=0.0417,0.0233,-0.0284,0,0,0
PATH=$PWD/build/bin:$PATH
rm -rf "$out"
mkdir -p "$out/test"

hgmm-import pcd "$data/scans" --poses "$data/poses_tum.txt" --sensor-pose $sensor \
    -o "$out/all.rawlog" --poses-out "$out/all.tum" >/dev/null
hgmm-replay "$out/all.rawlog" --poses "$out/all.tum" --split 5 --quiet \
    --save-map "$out/map.hgmm" >"$out/map.log"
# The scans that --split 5 leaves out.
number=0
for scan in "$data"/scans/*.pcd; do
    if ((number % 5 == 2)); then ln -s "$scan" "$out/test/"; fi
    number=$((number + 1))
done
grep -v '^#' "$data/poses_tum.txt" | awk '(NR - 1) % 5 == 2' >"$out/test.tum"
sed 's|= mylog.rawlog|= test.rawlog|; s|= mymap.hgmm|= ../map.hgmm|' "$config" >"$out/config.ini"

localise() { # RUN
    mkdir "$out/$1"
    cd "$out/$1"
    hgmm-import pcd ../test --poses ../test.tum --sensor-pose "$sensor" --actions \
        --odometry-noise 0.05,1 --seed "$1" -o test.rawlog --poses-out truth.tum >/dev/null
    local start end
    start=$(date +%s.%N)
    LD_PRELOAD=$out/../lib/libmrpt-hgmm.so OMP_NUM_THREADS=1 \
        pf-localization ../config.ini </dev/null >log 2>&1 || { echo "$1 failed"; return; }
    end=$(date +%s.%N)
    grep 'PDF estimation' log | sed -E 's/.*=\(([^)]*)\).*/\1/; s/deg//g; s/,/ /g' >estimates
    # Error of position, and angle between the two orientations.
    paste -d ' ' <(grep -v '^#' truth.tum) estimates | awk '
        BEGIN { rad = atan2(0, -1) / 180 }
        {
            cy = cos($12 * rad / 2); sy = sin($12 * rad / 2)
            cp = cos($13 * rad / 2); sp = sin($13 * rad / 2)
            cr = cos($14 * rad / 2); sr = sin($14 * rad / 2)
            dot = $8 * (cr * cp * cy + sr * sp * sy) + $5 * (sr * cp * cy - cr * sp * sy) \
                + $6 * (cr * sp * cy + sr * cp * sy) + $7 * (cr * cp * sy - sr * sp * cy)
            if (dot < 0) dot = -dot
            if (dot > 1) dot = 1
            print sqrt(($2 - $9) ^ 2 + ($3 - $10) ^ 2 + ($4 - $11) ^ 2), \
                2 * atan2(sqrt(1 - dot * dot), dot) / rad
        }' >errors
    local metres degrees
    metres=$(tail -n +21 errors | awk '{ print $1 }' | sort -g | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }')
    degrees=$(tail -n +21 errors | awk '{ print $2 }' | sort -g | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }')
    awk -v run="$1" -v m="$metres" -v d="$degrees" -v n="$(wc -l <errors)" -v s="$end" -v b="$start" \
        'BEGIN { printf("| %d | %s | %.3f | %.2f | %.2f |\n", run, (m < 0.3 && d < 2 ? "yes" : "no"), m, d, (s - b) / n) }'
}
export -f localise
export out sensor PATH
echo '| run | success | median error [m] | median error [deg] | seconds per update, 1000 particles |'
echo '| --- | --- | --- | --- | --- |'
seq "$runs" | xargs -P "$(nproc)" -I{} bash -c 'localise {}' | sort
