#!/usr/bin/env bash
# Says which lines and branches of the core its tests run, and lists the lines that they do not.
#   scripts/coverage.sh [FILTER]    of GoogleTest; all tests of the core if not given
# The table is printed; the lines go to build-coverage/uncovered.txt as FILE:LINE.
set -euo pipefail
cd "$(dirname "$0")/.."
out=build-coverage
tool() { command -v "$1" || compgen -c "$1-" | sort -V | tail -1; }
profdata=$(tool llvm-profdata) && cov=$(tool llvm-cov) || {
    echo 'llvm-profdata and llvm-cov are missing: package llvm' >&2
    exit 1
}

cmake --preset release -B $out -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_COMPILER=clang++ \
    -DCMAKE_CXX_FLAGS='-fprofile-instr-generate -fcoverage-mapping' \
    -DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 \
    -DHGMM_BUILD_MRPT=OFF -DHGMM_BUILD_BENCH=OFF -DHGMM_BUILD_PYTHON=OFF >/dev/null
cmake --build $out --target test-hgmm
LLVM_PROFILE_FILE=$out/tests.profraw $out/tests/test-hgmm --gtest_brief=1 --gtest_filter="${1:-*}"
"$profdata" merge -sparse $out/tests.profraw -o $out/tests.profdata
seen=("$out/tests/test-hgmm" "-instr-profile=$out/tests.profdata")
"$cov" report "${seen[@]}" -show-region-summary=false libs/hgmm |
    awk 'NR == 1 || $1 ~ /\.(cpp|h)$|TOTAL/'
"$cov" export "${seen[@]}" -format=lcov libs/hgmm |
    awk -F: -v root="$PWD/" '/^SF:/ { file = $2; sub(root, "", file) }
        /^DA:/ { split($2, line, ","); if (line[2] == 0) print file ":" line[1] }' \
        >$out/uncovered.txt.part
mv $out/uncovered.txt.part $out/uncovered.txt
echo "$(wc -l <$out/uncovered.txt) lines are not run: $out/uncovered.txt"
