#!/usr/bin/env bash
# Shows that a map is the same bytes with any number of threads and any instruction set, and answers
# the same with another compiler: prints a table of hashes, exits with 1 on any difference.
#   scripts/same_bytes.sh LOG.rawlog ...    beside each its poses, LOG.tum, as hgmm-import writes them
# GCC's libraries are those of build/, clang's are built in build-same/; a second run builds nothing.
# HGMM_COMPILERS="g++" leaves clang out.
set -euo pipefail
cd "$(dirname "$0")/.."
out=$PWD/build-same
export OMP_WAIT_POLICY=passive OMP_DYNAMIC=false
unset LD_LIBRARY_PATH LD_PRELOAD GLIBC_TUNABLES
read -ra compilers <<<"${HGMM_COMPILERS:-g++ clang++}"
different=0

# Takes from glibc its functions for AVX2, which MRPT and Eigen call. The library's own loops look at the
# processor; tests/hgmm/band_kernel_test.cpp compares theirs bit for bit.
withoutAvx2=glibc.cpu.hwcaps=-AVX2,-FMA

# build COMPILER: its libraries and program.
build() {
    local tree=$out/$1-libraries log=$out/$1.log
    local options=(-B "$tree" -DCMAKE_CXX_COMPILER="$1" -DHGMM_BUILD_TESTS=OFF -DHGMM_BUILD_BENCH=OFF
        -DHGMM_BUILD_PYTHON=OFF)
    [[ $1 == g++ ]] && tree=$PWD/build options=()
    {
        cmake --preset release "${options[@]}" &&
            cmake --build "$tree" --target hgmm mrpt-hgmm &&
            cmake -S bench/equality -B "$out/$1" -G Ninja -DCMAKE_BUILD_TYPE=Release \
                -DCMAKE_CXX_COMPILER="$1" -DHGMM_TREE="$PWD" -DHGMM_BUILD="$tree" &&
            cmake --build "$out/$1" --target map_hash
    } >"$log" 2>&1 || {
        tail -n 30 "$log" >&2
        exit 2
    }
}

# ask COMPILER RECORDING THREADS TUNABLES: sets hash, and writes the answers.
ask() {
    answers=$out/$(basename "$2" .rawlog)-$1.answers
    hash=$(OMP_NUM_THREADS=$3 GLIBC_TUNABLES=$4 "$out/$1/map_hash" "$2" "${2%.rawlog}.tum" \
        "$out/$(basename "$2" .rawlog).points" "$answers")
}

# row COMPILER RECORDING: a line of the table.
row() {
    local cells=() threads first
    for threads in 1 2 4; do
        ask "$1" "$2" "$threads" ''
        cells+=("${hash% *}")
    done
    ask "$1" "$2" 2 "$withoutAvx2"
    cells+=("${hash% *}")
    first=${cells[0]}
    for cell in "${cells[@]}"; do [[ $cell == "$first" ]] || different=1; done
    printf '| %s | %s | %s | %s | %s | %s |\n' "$(basename "$2" .rawlog)" "$1" "${cells[@]}"
}

(($#)) || { sed -n '2,5p' "$0" >&2; exit 2; }
mkdir -p "$out"
for compiler in "${compilers[@]}"; do build "$compiler"; done
echo '| recording | compiler | 1 thread | 2 threads | 4 threads | 2, no AVX2 |'
echo '| --- | --- | --- | --- | --- | --- |'
for recording in "$@"; do
    rm -f "$out/$(basename "$recording" .rawlog).points"
    for compiler in "${compilers[@]}"; do row "$compiler" "$recording"; done
done
[[ ${#compilers[@]} == 2 ]] || exit "$different"
echo
echo 'Largest difference of answers between the compilers:'
for recording in "$@"; do
    name=$(basename "$recording" .rawlog)
    printf '%s: ' "$name"
    "$out/${compilers[0]}/map_hash" --compare "$out/$name-${compilers[0]}.answers" \
        "$out/$name-${compilers[1]}.answers" || different=1
done
exit "$different"
