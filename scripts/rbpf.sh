#!/usr/bin/env bash
# Maps the Telecom loop with stock rbpf-slam, once for each seed, with our map in each particle
# and with MRPT's grid map (its stock options) in its place; all else is the same.
#   scripts/rbpf.sh [SEEDS [MAP...]]        default: seeds 1 to 10 of hgmm and grid
# SEEDS is a number, or FIRST-LAST. A run succeeds if it ends within 0.5 m and 3 deg of the
# pose that MRPT's own tests expect. That pose came from a grid map; matching the scans of the
# second pass through the corridor directly with those of the first puts the robot 0.9 m and
# 1.2 deg away from it, at (4.23, -18.46, -87.7 deg), hence the other columns. Needs a build.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/runs.sh
seedRange "${1:-1-10}"
maps=("${@:2}")
[[ ${#maps[@]} -gt 0 ]] || maps=(hgmm grid)
out=$PWD/build/rbpf
rm -rf "$out"
mkdir -p "$out"
rbpfConfigs "$out"

run() { # MAP SEED
    runRbpf "$1" "$2" || return 0
    grep 'yaw,pitch,roll)=' log | tail -1 |
        sed -E 's/.*\)=\(([-0-9.]+),([-0-9.]+),[-0-9.]+,([-0-9.]+)deg.*/\1 \2 \3/' |
        awk -v map="$1" -v seconds="$seconds" '
            function apart(a, b) { a -= b; while (a > 180) a -= 360; while (a < -180) a += 360; return a < 0 ? -a : a }
            { printf("%s %.3f %.2f %.3f %.2f %.1f\n", map,
                  sqrt(($1 - 3.4548) ^ 2 + ($2 + 18.0399) ^ 2), apart($3, -86.48),
                  sqrt(($1 - 4.23) ^ 2 + ($2 + 18.46) ^ 2), apart($3, -87.7), seconds) }'
}
export -f run runRbpf
export out
for seed in $(seq "$firstSeed" "$lastSeed"); do
    for map in "${maps[@]}"; do echo "$map $seed"; done
done | xargs -P "$(nproc)" -L 1 bash -c 'run $0 $1' >"$out/runs.txt"

echo '| map | runs | within 0.5 m, 3 deg | median error | median error by direct matching | median seconds |'
echo '| --- | --- | --- | --- | --- | --- |'
for map in "${maps[@]}"; do
    of() { figures "$map" 6 "$1" | median; }
    printf '| %s | %d | %d | %.2f m, %.1f deg | %.2f m, %.1f deg | %.1f |\n' "$map" \
        "$(figures "$map" 6 1 | wc -l)" "$(successes "$map" 6 0.5 3)" \
        "$(of 2)" "$(of 3)" "$(of 4)" "$(of 5)" "$(of 6)"
done
