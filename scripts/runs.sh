# Sourced by scripts that compare maps over many runs. $out/runs.txt has a line for each run that
# ended: the map, then its figures. Lines of other lengths are failures.

# The middle of a column of numbers, the mean of the middle two if there is no one.
median() {
    sort -g | awk '{ v[NR] = $1 } END { if (NR) print NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'
}

# figures MAP COUNT COLUMN: a column of the map's runs, which have COUNT columns.
figures() {
    awk -v map="$1" -v count="$2" -v column="$3" '$1 == map && NF == count { print $column }' "$out/runs.txt"
}

# successes MAP COUNT METRES DEGREES: how many runs have figures 2 and 3 within these limits.
successes() {
    awk -v map="$1" -v count="$2" -v metres="$3" -v degrees="$4" \
        '$1 == map && NF == count && $2 <= metres && $3 <= degrees { ++n } END { print n + 0 }' "$out/runs.txt"
}

# seedRange SEEDS: sets firstSeed and lastSeed from a number, or FIRST-LAST.
seedRange() {
    [[ $1 == *-* ]] && firstSeed=${1%-*} || firstSeed=1
    lastSeed=${1#*-}
}

# rbpfConfigs FOLDER: writes hgmm.ini, the shipped configuration of rbpf-slam, and grid.ini, the same
# but for the map, which is MRPT's grid with its stock options.
rbpfConfigs() {
    local config=share/mrpt-hgmm/config_files/rbpf-slam.ini
    local stock=/usr/share/mrpt/config_files/rbpf-slam/gridmapping_optimal_sampling.ini
    cp "$config" "$1/hgmm.ini"
    {
        sed '/^hgmmMap_count/,$d' "$config"
        echo 'occupancyGrid_count = 1'
        sed -n '/^\[MappingApplication_occupancyGrid_00_creationOpts\]/,$p' "$stock"
    } >"$1/grid.ini"
}

# runRbpf MAP SEED: runs rbpf-slam in $out/MAP-SEED, where it leaves the shell; sets `seconds`, of the processor, for other
# programs may be running.
runRbpf() {
    mkdir "$out/$1-$2"
    cd "$out/$1-$2"
    sed "s/^RANDOM_SEED .*/RANDOM_SEED = $2/" "../$1.ini" >config.ini
    local TIMEFORMAT='%U %S'
    seconds=$({ time LD_PRELOAD=$out/../lib/libmrpt-hgmm.so OMP_NUM_THREADS=1 \
        rbpf-slam config.ini </dev/null >log 2>&1; } 2>&1) || { echo "$1 $2 failed"; return 1; }
    seconds=$(awk '{ printf("%.1f", $1 + $2) }' <<<"$seconds")
}
