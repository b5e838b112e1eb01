#!/usr/bin/env bash
# Runs stock configurations of MRPT with the map's line swapped and nothing else, beside the
# original. Where the program insists on a grid or points map, ours is added to it. Every option of
# the map has its default.
#   scripts/stock.sh [RUNS [CONFIGURATION...]]      default: 10 runs of each
# CONFIGURATION: localisation (localization_demo.ini; its start box, for mode 0 needs a grid),
# optimal (gridmapping_optimal_sampling.ini), plain (rbpf-slam as many set it up: standard proposal, 30
# particles, odometry), icp-points or icp-grid (gridmapping_RBPF_[grid_]ICPbased_malaga.ini, which
# match scans with such a map), lm, classic or gridmatch (icp-slam_demo_*.ini; one run is all of
# them). Right is, for localisation, within 0.15 m and 1.5 deg of the published pose; for the others,
# within 0.15 m of the end that direct matching of scans gives. PLUGIN names another plugin, JOBS
# how many run at a time, 1 if unset. Needs a build.
# Not here: localization_demo_obsonly_rawlog, intel, with_octomap, three lasers and noses, whose logs
# MRPT does not come with, and beacons, which our map does not observe.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/runs.sh
runs=${1:-10}
configurations=("${@:2}")
[[ ${#configurations[@]} -gt 0 ]] ||
    configurations=(localisation optimal plain icp-points icp-grid lm classic gridmatch)
plugin=$(realpath "${PLUGIN:-build/lib/libmrpt-hgmm.so}")
stock=/usr/share/mrpt/config_files
out=$PWD/build/stock
rm -rf "$out"
mkdir -p "$out"

# Paths, and what would open windows or write logs.
quiet() { # FILE
    sed -e 's#\.\./\.\./datasets#/usr/share/mrpt/datasets#' -e 's/^LOG_FREQUENCY *=.*/LOG_FREQUENCY=100000/' \
        -e 's/^\(SAVE_[A-Z0-9_]*\|SHOW_PROGRESS_IN_WINDOW\) *=.*/\1=0/' -e 's/^logOutput_dir *=.*/logOutput_dir=LOG/' \
        -e 's/SHOW_PROGRESS_3D_REAL_TIME.*/SHOW_PROGRESS_3D_REAL_TIME=false/' \
        -e 's/^verbosity_level.*/verbosity_level=INFO/' -e 's/^init_PDF_mode=0/init_PDF_mode=1/' "$1" | tr -d '\r'
}
quiet $stock/pf-localization/localization_demo.ini >"$out/localisation-stock.ini"
quiet $stock/rbpf-slam/gridmapping_optimal_sampling.ini >"$out/optimal-stock.ini"
quiet $stock/rbpf-slam/gridmapping_RBPF_ICPbased_malaga.ini >"$out/icp-points-stock.ini"
quiet $stock/rbpf-slam/gridmapping_RBPF_grid_ICPbased_malaga.ini >"$out/icp-grid-stock.ini"
quiet $stock/icp-slam/icp-slam_demo_LM.ini >"$out/lm-stock.ini"
quiet $stock/icp-slam/icp-slam_demo_classic.ini >"$out/classic-stock.ini"
quiet $stock/icp-slam/icp-slam_demo_classic_gridmatch.ini >"$out/gridmatch-stock.ini"
cat >"$out/plain-stock.ini" <<'INI'
[MappingApplication]
rawlog_file=/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog
rawlog_offset=0
logOutput_dir=LOG
LOG_FREQUENCY=100000
insertionLinDistance=1.2
insertionAngDistance_deg=35
localizeLinDistance=0.4
localizeAngDistance_deg=10
verbosity_level=INFO
PF_algorithm=0
adaptiveSampleSize=0
resamplingMethod=0
sampleSize=30
BETA=0.5
likelihoodMapSelection=-1
pfOptimalProposal_mapSelection=0
pfAuxFilterOptimal_MaximumSearchSamples=250
KLD_maxSampleSize=150
KLD_minSampleSize=15
KLD_binSize_XY=0.03
KLD_binSize_PHI_deg=1
KLD_delta=0.001
KLD_epsilon=0.5
occupancyGrid_count=1
[MappingApplication_occupancyGrid_00_creationOpts]
resolution=0.06
INI
for configuration in localisation optimal plain; do
    sed 's/^occupancyGrid_count=1.*/occupancyGrid_count=0\nhgmmMap_count=1/' \
        "$out/$configuration-stock.ini" >"$out/$configuration-hgmm.ini"
done
for configuration in icp-points icp-grid lm classic gridmatch; do
    sed -E 's/^(occupancyGrid_count|pointsMap_count) *= *1.*/&\nhgmmMap_count=1/' \
        "$out/$configuration-stock.ini" >"$out/$configuration-hgmm.ini"
done

# A line of a run: configuration-map, metres, degrees, seconds of the processor.
run() { # CONFIGURATION MAP RUN
    local folder=$out/$1-$2-$3 program=rbpf-slam preload='' end=4.23,-18.46,-87.7 TIMEFORMAT='%U %S' seconds
    mkdir "$folder"
    cd "$folder"
    case $1 in
        localisation) program=pf-localization end=15.89,-10.0,4.8 ;;
        lm | classic | gridmatch) program=icp-slam ;;
    esac
    # pf-localization seeds itself from the clock.
    sed "s/^\[MappingApplication\]/&\nRANDOM_SEED=$3/" "../$1-$2.ini" >config.ini
    [[ $2 == stock ]] || preload=$plugin
    seconds=$({ time LD_PRELOAD=$preload OMP_NUM_THREADS=1 $program config.ini </dev/null >log 2>&1; } 2>&1) ||
        { echo "$1-$2 failed"; return; }
    if [[ $program == pf-localization ]]; then
        grep -o 'PDF estimation: ([^)]*)' log | tail -1 | sed -E 's/.*\((.*),(.*),(.*)deg\)/\1 \2 \3/'
    else
        # Of icp-slam, without z, pitch and roll.
        tail -1 LOG*/log_estimated_path.txt | awk '{ print $2, $3, (NF < 6 ? $4 : $5) * 57.29577951 }'
    fi | awk -v run="$1-$2" -v end="$end" -v seconds="$seconds" '{
        split(end, e, ","); split(seconds, s, " ")
        turn = $3 - e[3]; while (turn > 180) turn -= 360; while (turn < -180) turn += 360
        printf("%s %.3f %.2f %.2f\n", run, sqrt(($1 - e[1]) ^ 2 + ($2 - e[2]) ^ 2), turn < 0 ? -turn : turn, s[1] + s[2]) }'
}
export -f run
export out plugin
for configuration in "${configurations[@]}"; do
    last=$runs
    case $configuration in lm | classic | gridmatch) last=1 ;; esac
    for number in $(seq "$last"); do
        for map in hgmm stock; do echo "$configuration $map $number"; done
    done
done | xargs -P "${JOBS:-1}" -L 1 bash -c 'run $0 $1 $2' >"$out/runs.txt"

echo '| configuration | map | runs | right | median error | worst | median seconds of the processor |'
echo '| --- | --- | --- | --- | --- | --- | --- |'
for configuration in "${configurations[@]}"; do
    degrees=360
    [[ $configuration != localisation ]] || degrees=1.5
    for map in hgmm stock; do
        of() { figures "$configuration-$map" 4 "$1"; }
        printf '| %s | %s | %d | %d | %.2f m, %.1f deg | %.2f m | %.1f |\n' "$configuration" "$map" \
            "$(grep -c "^$configuration-$map " "$out/runs.txt")" "$(successes "$configuration-$map" 4 0.15 "$degrees")" \
            "$(of 2 | median)" "$(of 3 | median)" "$(of 2 | sort -g | tail -1)" "$(of 4 | median)"
    done
done
