#!/usr/bin/env bash
# Localises a handheld 3D lidar in all six dimensions with stock pf-localization: the map holds
# four of five scans of livox_building, the others are localised in it, with noisy 3D odometry,
# from a start spread of +-2 m, +-10 deg, 1000 particles: in our map, and in MRPT's points map.
#   HGMM_DATA_DIR=../shared/data scripts/localisation3d.sh [RUNS [MAP...]]
# Default: 5 runs of hgmm and points. A run succeeds if, after the first 20 updates, its median
# error is below 0.3 m and 2 deg. Needs a build. Everything it makes is in build/localisation3d.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/runs.sh
: "${HGMM_DATA_DIR:?names no folder of recordings}"
data=$(cd "$HGMM_DATA_DIR" && pwd)/livox_building
runs=${1:-5}
maps=("${@:2}")
[[ ${#maps[@]} -gt 0 ]] || maps=(hgmm points)
out=$PWD/build/localisation3d
config=$PWD/share/mrpt-hgmm/config_files/pf-localization-3d.ini
sensor=0.0417,0.0233,-0.0284,0,0,0
PATH=$PWD/build/bin:$PATH
rm -rf "$out"
mkdir -p "$out/test" "$out/mapping"

# Every fifth scan, from the third on, is localised.
number=0
for scan in "$data"/scans/*.pcd; do
    if ((number % 5 == 2)); then ln -s "$scan" "$out/test/"; else ln -s "$scan" "$out/mapping/"; fi
    number=$((number + 1))
done
grep -v '^#' "$data/poses_tum.txt" | awk '(NR - 1) % 5 == 2' >"$out/test.tum"
grep -v '^#' "$data/poses_tum.txt" | awk '(NR - 1) % 5 != 2' >"$out/mapping.tum"
hgmm-import pcd "$out/mapping" --poses "$out/mapping.tum" --match order --sensor-pose $sensor \
    -o "$out/mapping.rawlog" --poses-out "$out/mapping.out.tum" \
    --cloud "$out/points.simplemap" >/dev/null
hgmm-replay "$out/mapping.rawlog" --poses "$out/mapping.out.tum" --quiet \
    --save-map "$out/map.hgmm" >"$out/map.log"

# Everything but the map is the same.
sed 's|= mylog.rawlog|= test.rawlog|; s|= mymap.hgmm|= ../map.hgmm|' "$config" >"$out/hgmm.ini"
sed '/^\[MetricMap\]/,$d; s|= mylog.rawlog|= test.rawlog|; s|^map_file .*|map_file = ../points.simplemap|' \
    "$config" >"$out/points.ini"
cat >>"$out/points.ini" <<'INI'
[MetricMap]
pointsMap_count = 1
likelihoodMapSelection = -1
[MetricMap_pointsMap_00_insertOpts]
minDistBetweenLaserPoints = 0
[MetricMap_pointsMap_00_likelihoodOpts]
sigma_dist = 0.01
max_corr_distance = 1
decimation = 50
INI

localise() { # MAP RUN
    mkdir "$out/$1-$2"
    cd "$out/$1-$2"
    hgmm-import pcd ../test --poses ../test.tum --match order --sensor-pose "$sensor" --actions \
        --odometry-noise 0.05,1 --seed "$2" -o test.rawlog --poses-out truth.tum >/dev/null
    local start end
    start=$(date +%s.%N)
    LD_PRELOAD=$out/../lib/libmrpt-hgmm.so OMP_NUM_THREADS=1 \
        pf-localization "../$1.ini" </dev/null >log 2>&1 || { echo "$1 failed"; return; }
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
    metres=$(tail -n +21 errors | awk '{ print $1 }' | median)
    degrees=$(tail -n +21 errors | awk '{ print $2 }' | median)
    echo "$1 $metres $degrees $start $end $(wc -l <errors)" |
        awk '{ printf("%s %.3f %.2f %.3f\n", $1, $2, $3, ($5 - $4) / $6) }'
}
export -f localise median
export out sensor PATH
for map in "${maps[@]}"; do
    for run in $(seq "$runs"); do echo "$map $run"; done
done | xargs -P "$(nproc)" -L 1 bash -c 'localise $0 $1' >"$out/runs.txt"

echo '| map | runs | within 0.3 m, 2 deg | median error [m] | [deg] | seconds per update |'
echo '| --- | --- | --- | --- | --- | --- |'
for map in "${maps[@]}"; do
    of() { figures "$map" 4 "$1" | median; }
    echo "| $map | $runs | $(successes "$map" 4 0.3 2) | $(of 2) | $(of 3) | $(of 4) |"
done
