#!/usr/bin/env bash
# Maps the whole log of the Intel lab (13 631 scans of a 2D laser) with stock rbpf-slam, once
# with our map in each particle and once with MRPT's grid map in its place; all else is the same.
#   HGMM_DATA_DIR=../shared/data scripts/intel.sh [SEEDS [MAP...]]    default: seed 1 of hgmm and grid
# SEEDS is a number, or FIRST-LAST. The log says that its laser sees 90 deg; its scans agree with each
# other over full turns at 179 deg (180 rays, a degree apart). Its odometry turns by 3 deg on a
# straight metre: the motion model is told of a deviation of 5. rbpf-slam needs pairs of actions and sensory
# frames. hgmm-import does all three. Needs a build. Maps and pictures are in build/intel.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/runs.sh
: "${HGMM_DATA_DIR:?names no folder of recordings}"
log=$(cd "$HGMM_DATA_DIR" && pwd)/laser2d/intel.rawlog
seedRange "${1:-1-1}"
maps=("${@:2}")
[[ ${#maps[@]} -gt 0 ]] || maps=(hgmm grid)
out=$PWD/build/intel
PATH=$PWD/build/bin:$PATH
rm -rf "$out"
mkdir -p "$out"
hgmm-import rawlog "$log" --aperture 179 --actions --turn-error 5 \
    -o "$out/intel.rawlog" --poses-out "$out/odometry.tum"
rbpfConfigs "$out"
sed -i "s|^rawlog_file .*|rawlog_file = $out/intel.rawlog|" "$out/hgmm.ini" "$out/grid.ini"

run() { # MAP SEED
    runRbpf "$1" "$2" || return 0
    local folder=$out/$1-$2/LOG_RBPF bytes
    # Not left to -e, which does not hold here.
    if [[ $1 == hgmm ]]; then
        mv "$folder"/finalMap_*.hgmm "$out/$1-$2.hgmm" &&
            hgmm-map export "$out/$1-$2.hgmm" "$out/$1-$2.yaml" --height 0 >/dev/null &&
            hgmm-map export "$out/$1-$2.hgmm" "$out/$1-$2.png" >/dev/null &&
            bytes=$(stat -c %s "$out/$1-$2.hgmm")
    else
        mv "$folder"/finalMap_*.png "$out/$1-$2.png" && bytes=$(stat -c %s "$out/$1-$2.png")
    fi || { echo "$1 $2 left no map"; return 0; }
    echo "$1 $2 $seconds $((bytes / 1000))"
}
export -f run runRbpf
export out PATH
for seed in $(seq "$firstSeed" "$lastSeed"); do
    for map in "${maps[@]}"; do echo "$map $seed"; done
done | xargs -P "$(nproc)" -L 1 bash -c 'run $0 $1' >"$out/runs.txt"

echo '| map | seed | seconds of the processor | KB on disk | picture |'
echo '| --- | --- | --- | --- | --- |'
awk -v out="$out" 'NF == 4 { printf("| %s | %s | %s | %s | %s/%s-%s.png |\n", $1, $2, $3, $4, out, $1, $2) }
    NF != 4 { print }' "$out/runs.txt"
