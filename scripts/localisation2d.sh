#!/usr/bin/env bash
# Localises a 2D laser robot from a uniform start, in separate runs of stock pf-localization,
# which seeds itself from the clock: in our map, in MRPT's grid map and in its points map.
#   scripts/localisation2d.sh [RUNS [MAP...]]        default: 20 runs of hgmm, grid and points
# A run succeeds if it ends within 0.15 m and 1.5 deg of the published pose. Needs a build.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/runs.sh
runs=${1:-20}
maps=("${@:2}")
[[ ${#maps[@]} -gt 0 ]] || maps=(hgmm grid points)
out=$PWD/build/localisation
config=$PWD/share/mrpt-hgmm/config_files/pf-localization.ini
stock=/usr/share/mrpt/config_files/pf-localization/localization_demo.ini
rm -rf "$out"
mkdir -p "$out"

# Everything but the map is the same.
cp "$config" "$out/hgmm.ini"
sed '/^\[MetricMap\]/,$d' "$config" >"$out/grid.ini"
sed -n '/^\[MetricMap\]/,$p' "$stock" >>"$out/grid.ini"
sed '/^\[MetricMap\]/,$d' "$config" >"$out/points.ini"
cat >>"$out/points.ini" <<'INI'
[MetricMap]
pointsMap_count = 1
likelihoodMapSelection = -1
[MetricMap_pointsMap_00_insertOpts]
minDistBetweenLaserPoints = 0.05
isPlanarMap = 1
[MetricMap_pointsMap_00_likelihoodOpts]
sigma_dist = 0.25
max_corr_distance = 1
decimation = 12
INI

localise() { # MAP RUN
    local folder=$out/$1-$2
    mkdir "$folder"
    cd "$folder"
    local start end
    start=$(date +%s.%N)
    LD_PRELOAD=$out/../lib/libmrpt-hgmm.so OMP_NUM_THREADS=1 \
        pf-localization "../$1.ini" </dev/null >log 2>&1 || { echo "$1 failed"; return; }
    end=$(date +%s.%N)
    grep 'PDF estimation' log | tail -1 |
        sed -E "s/.*estimation: \(([-0-9.]+),([-0-9.]+),([-0-9.]+)deg\).*/$1 \1 \2 \3/" |
        awk -v from="$start" -v to="$end" '{
            yaw = $4 - 4.8; if (yaw < 0) yaw = -yaw
            printf("%s %.3f %.2f %.1f\n", $1, sqrt(($2 - 15.89) ^ 2 + ($3 + 10.0) ^ 2), yaw, to - from) }'
}
export -f localise
export out
for map in "${maps[@]}"; do
    for run in $(seq "$runs"); do echo "$map $run"; done
done | xargs -P "$(nproc)" -L 1 bash -c 'localise $0 $1' >"$out/runs.txt"

echo '| map | runs | within 0.15 m, 1.5 deg | median error [m] | worst [m] | median seconds |'
echo '| --- | --- | --- | --- | --- | --- |'
for map in "${maps[@]}"; do
    of() { figures "$map" 4 "$1"; }
    printf '| %s | %d | %d | %.3f | %.3f | %.1f |\n' "$map" "$runs" "$(successes "$map" 4 0.15 1.5)" \
        "$(of 2 | median)" "$(of 2 | sort -g | tail -1)" "$(of 4 | median)"
done
