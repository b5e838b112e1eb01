#!/usr/bin/env bash
# Fuzzes what reads bytes that others made (tests/fuzz), and says how many inputs were run.
#   scripts/fuzz.sh [SECONDS]             the harnesses of the core, each so long (5)
#   scripts/fuzz.sh --all SECONDS [NAME ...]   those of the plugin and the importer, too; adds a line each to
#                                         tests/fuzz/log.md. Resumable: inputs that reach new code are kept in
#                                         build-fuzz/corpus
#   scripts/fuzz.sh --random N            N more random sequences of calls, from where the log ends
# A finding is written to build-fuzz/findings and ends its own harness only; exit code 1. Mend it, and put the
# file into tests/fuzz/corpus/NAME.
set -euo pipefail
cd "$(dirname "$0")/.."
log=tests/fuzz/log.md
core=(map-load scan sequence)
rest=(mrpt-object ini-options import-folders)

# build ON|OFF NAME...
build() {
    local mrpt=$1
    shift
    cmake --preset fuzz -DHGMM_BUILD_MRPT="$mrpt" >/dev/null
    cmake --build build-fuzz --target "${@/#/fuzz-}"
    mkdir -p build-fuzz/findings
}

# fuzz NAME SECONDS: sets executions, edges, findings and how long it ran.
fuzz() {
    local name=$1 seconds=$2 said=build-fuzz/said-$1
    mkdir -p "build-fuzz/corpus/$name"
    findings=0 spent=$SECONDS
    OMP_NUM_THREADS=1 nice -n 19 "build-fuzz/fuzz/fuzz-$name" -max_total_time="$seconds" -timeout=30 \
        -rss_limit_mb=2048 -print_final_stats=1 -artifact_prefix="build-fuzz/findings/$name-" \
        "build-fuzz/corpus/$name" "tests/fuzz/corpus/$name" >"$said" 2>&1 || findings=1
    spent=$((SECONDS - spent))
    executions=$(awk '/stat::number_of_executed_units/ { print $2 }' "$said")
    edges=$(sed -nE 's/.* cov: ([0-9]+) .*/\1/p' "$said" | tail -1)
    printf '%-16s %8s s %10s executions %6s edges, %s\n' "$name" "$spent" "${executions:-0}" "${edges:-0}" \
        "$( ((findings)) && echo "A FINDING: $said" || echo 'no finding')"
}

note() { printf '| %s | %s | %s | %s | %s | %s | %s |\n' "$(date -u +%Y-%m-%d\ %H:%M)" "$(git rev-parse --short HEAD)" "$@" >>"$log"; }

found=0
case ${1:-} in
    --all)
        seconds=${2:?seconds}
        shift 2
        (($#)) || set -- "${core[@]}" "${rest[@]}"
        build ON "$@"
        for name in "$@"; do
            fuzz "$name" "$seconds"
            note "$name" "$spent" "${executions:-0}" "${edges:-0}" "$findings"
            found=$((found + findings))
        done
        ;;
    --random)
        build=build
        first=$(awk -F'[ |]+' '/random to/ { last = $7 } END { print last + 1 }' "$log")
        cmake --preset release >/dev/null && cmake --build --preset release --target fuzz-sequence
        SECONDS=0
        OMP_NUM_THREADS=1 nice -n 19 "$build/fuzz/fuzz-sequence" --random "${2:?count}" "$first" || found=1
        note "random to $((first + $2 - 1))" "$SECONDS" "$2" - "$found"
        ;;
    *)
        build OFF "${core[@]}"
        for name in "${core[@]}"; do
            fuzz "$name" "${1:-5}"
            found=$((found + findings))
        done
        ;;
esac
((found == 0))
