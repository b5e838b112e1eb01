#!/usr/bin/env bash
# Runs clang-tidy, with the checks of .clang-tidy, over sources that changed. Any finding is an error.
#   scripts/tidy.sh [BASE_COMMIT]    since then, HEAD~1 if not given, and what is not committed
#   scripts/tidy.sh --core           over all sources of libs/hgmm
set -euo pipefail
cd "$(dirname "$0")/.."

if [[ ${1:-} == --core ]]; then
    mapfile -t files < <(git ls-files 'libs/hgmm/src/*.cpp')
else
    base=$(git rev-parse --verify --quiet "${1:-HEAD~1}^{commit}") || {
        [[ -z ${1:-} ]] || { echo "no commit: $1"; exit 1; }
        echo 'the first commit of this clone: nothing to compare with'
        exit 0
    }
    mapfile -t files < <(git diff --name-only --diff-filter=d "$base" -- 'libs/*.cpp' 'apps/*.cpp')
fi
((${#files[@]})) || {
    echo 'no sources changed'
    exit 0
}
# File by file and by clang: it reads no unity files, and no headers that GCC precompiled.
cmake --preset debug -B build-tidy -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
    -DHGMM_BUILD_PYTHON=OFF >/dev/null
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy -p build-tidy --quiet --warnings-as-errors='*'
