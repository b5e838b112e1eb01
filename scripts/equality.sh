#!/usr/bin/env bash
# Shows that maps of this tree are those of another commit, bit for bit: builds both, puts the same
# recordings into the maps of either, and compares all components and answers.
#   scripts/equality.sh [BASE_COMMIT]   default: HEAD~1; exits with 1 on any difference
#   scripts/equality.sh --self-test     plants one changed ulp, and fails unless it is found by name
# HGMM_DATA_DIR names the recordings, ../shared/data if unset. HGMM_BASE_TREE names a clone at
# BASE_COMMIT that is built in its build/, to be used as it is. Everything else is in
# build/equality. A second run builds nothing, and asks the base commit nothing.
set -euo pipefail
cd "$(dirname "$0")/.."
present=$(pwd -P)
out=$present/build/equality
telecom='/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog'
export OMP_WAIT_POLICY=passive
unset LD_LIBRARY_PATH LD_PRELOAD

fail() {
    echo "equality.sh: $*" >&2
    exit 2
}

# run LOG COMMAND...: prints what it wrote only if it fails.
run() {
    local log=$1
    shift
    "$@" >"$log" 2>&1 || {
        tail -n 40 "$log" >&2
        fail "failed: $*"
    }
}

# flagsOf BUILD: what decides about its machine code, as options of cmake.
flagsOf() {
    local type key
    type=$(sed -n 's/^CMAKE_BUILD_TYPE:[A-Z]*=//p' "$1/CMakeCache.txt")
    for key in CMAKE_BUILD_TYPE CMAKE_CXX_COMPILER CMAKE_CXX_FLAGS "CMAKE_CXX_FLAGS_${type^^}"; do
        sed -n "s/^$key:[A-Z]*=/-D$key=/p" "$1/CMakeCache.txt"
    done
}

buildPresent() {
    [[ -f build/CMakeCache.txt ]] || run "$out/configure.log" cmake --preset release
    run "$out/build.log" cmake --build build --target hgmm mrpt-hgmm
    mapfile -t flags < <(flagsOf build)
}

# Sets base to a built tree of the base commit.
buildBase() {
    base=${HGMM_BASE_TREE:-$out/base}
    if [[ -z ${HGMM_BASE_TREE:-} ]]; then
        [[ -d $base ]] || git clone -q --shared --no-checkout . "$base"
        git -C "$base" checkout -q --detach "$commit"
        (cd "$base" && run "$out/base-configure.log" cmake --preset release "${flags[@]}" \
            -DHGMM_BUILD_TESTS=OFF -DHGMM_BUILD_BENCH=OFF)
        run "$out/base-build.log" cmake --build "$base/build" --target hgmm mrpt-hgmm
    fi
    base=$(cd "$base" && pwd -P)
    [[ $(git -C "$base" rev-parse HEAD) == "$commit" ]] || fail "$base is not at $commit"
    git -C "$base" diff --quiet HEAD -- libs || fail "$base has changes in libs/"
    [[ $(flagsOf "$base/build") == "$(flagsOf build)" ]] ||
        fail "$base/build and build/ differ in compiler or flags"
}

# buildProgram NAME TREE: compiles the program with the headers and libraries of a tree.
buildProgram() {
    local folder=$out/program-$1
    run "$out/program-$1.log" cmake -S bench/equality -B "$folder" -G Ninja "${flags[@]}" \
        -DHGMM_TREE="$2" -DHGMM_BUILD="$2/build"
    run "$out/program-$1.log" cmake --build "$folder"
    [[ $(ldd "$folder/dump_answers" | grep -cF "=> $2/build/lib/") == 2 ]] ||
        fail "$folder/dump_answers does not use the libraries of $2"
}

# import NAME ARGUMENTS...: once, by this tree, so that both trees read the same files.
import() {
    local name=$1 recordings=$out/recordings
    shift
    [[ -f $recordings/$name.tum ]] && return
    mkdir -p "$recordings"
    run "$out/build.log" cmake --build build --target hgmm-import
    run "$recordings/$name.log" build/bin/hgmm-import "$@" -o "$recordings/$name.rawlog" \
        --poses-out "$recordings/$name.tum"
}

importAll() {
    local data=${HGMM_DATA_DIR:-../shared/data}
    [[ -d $data ]] || fail "HGMM_DATA_DIR names no folder of recordings"
    import rgbd_kitchen 7scenes "$data/rgbd_kitchen"
    import livox_building pcd "$data/livox_building/scans" \
        --poses "$data/livox_building/poses_tum.txt" --sensor-pose 0.0417,0.0233,-0.0284,0,0,0
    import sim_structured pcd "$data/la3dm_sim/sim_structured" --world-frame
    import sim_unstructured pcd "$data/la3dm_sim/sim_unstructured" --world-frame
    import telecom rawlog "$telecom"
}

# dump PROGRAM FILE RECORDING [OPTION=VALUE...]
dump() {
    local program=$out/program-$1/dump_answers file=$2 recording=$out/recordings/$3
    shift 3
    mkdir -p "$(dirname "$file")"
    "$program" --dump "$recording.rawlog" "$recording.tum" "$file.part" "$@" ||
        fail "no dump of $file"
    mv "$file.part" "$file"
}

# same NAME A B: prints what was compared, and what differs. The program's word and cmp must agree.
same() {
    local status=0 bytes=0
    "$out/program-present/dump_answers" --compare "$@" || status=$?
    [[ $status -le 1 ]] || fail "no comparison of $1"
    cmp -s "$2" "$3" || bytes=1
    [[ $status == "$bytes" ]] || fail "$1: the program and cmp disagree"
    return "$status"
}

# check NAME RECORDING [OPTION=VALUE...]: of the base, only what it was not asked before.
check() {
    local name=$1 old=$out/dumps/$commit/$1.dump new=$out/dumps/present/$1.dump
    shift
    [[ $old -nt $out/program-base/dump_answers && $old -nt $out/recordings/$1.tum ]] ||
        dump base "$old" "$@"
    dump present "$new" "$@"
    same "$name" "$old" "$new" || different=1
}

compareAll() {
    commit=$(git rev-parse --verify "$1^{commit}")
    buildPresent
    buildBase
    buildProgram present "$present"
    buildProgram base "$base"
    importAll
    echo "base $(git log -1 --format=%h "$commit") in $base, present tree in $present; ${flags[*]}"
    different=0
    check sim_structured sim_structured
    check sim_unstructured sim_unstructured
    check telecom telecom
    check rgbd_kitchen rgbd_kitchen
    check rgbd_kitchen_rgb rgbd_kitchen modalities=rgb
    check livox_building livox_building
    [[ $different == 0 ]] && echo "equal in all, after $SECONDS s" || echo "DIFFERENT, after $SECONDS s"
    return "$different"
}

# expectFound SECTION COLUMN ROW TEXT: changes one ulp there; the comparison must fail and say TEXT.
expectFound() {
    local dumps=$out/dumps/self-test status=0 said
    "$out/program-present/dump_answers" --plant "$dumps/whole.dump" "$dumps/planted.dump" "${@:1:3}"
    said=$(same planted "$dumps/whole.dump" "$dumps/planted.dump") || status=$?
    echo "$said"
    [[ $status == 1 && $said == *"    $4: "*"; 1 of "* ]] ||
        fail "self-test: a changed ulp in '$4' was not found by name"
}

selfTest() {
    local dumps=$out/dumps/self-test
    buildPresent
    buildProgram present "$present"
    import telecom rawlog "$telecom"
    dump present "$dumps/whole.dump" telecom
    cp "$dumps/whole.dump" "$dumps/copy.dump"
    same copy "$dumps/whole.dump" "$dumps/copy.dump" || fail "self-test: a copy differs"
    expectFound 'surfaces, level 0' 'mean x' 17 'surfaces, level 0: mean x of component 17'
    expectFound 'view directions, level 2' range 3 'view directions, level 2: range of view 3'
    expectFound 'occupancy, level 0' occupied 12346 'occupancy, level 0: occupied of point 12346'
    expectFound likelihoods 'log likelihood' 5 'likelihoods: log likelihood of pose 5'
    echo "self-test passed: each changed ulp was found by name, after $SECONDS s"
}

mkdir -p "$out"
case ${1:-} in
--self-test) selfTest ;;
-*) fail "usage: scripts/equality.sh [BASE_COMMIT | --self-test]" ;;
*) compareAll "${1:-HEAD~1}" ;;
esac
