#!/usr/bin/env bash
# Sees that scripts/check-includes.sh passes the sources as they are and refuses wrong includes.
#   includes_test.sh ROOT COPY    COPY: a folder to work in, deleted first
set -euo pipefail
root=$1 copy=$2
failed=0

fail() {
    echo "FAILED: $*"
    failed=1
}
# refused FILE HEADER WORDS WHAT: planted into FILE, the include is named with WORDS.
refused() {
    local file=$copy/$1 include="#include \"$2\"" said
    [[ -f $file ]] || {
        fail "$4: there is no $1 to plant an include in"
        return
    }
    cp "$file" "$copy/original"
    sed -i "1a $include" "$file"
    if said=$("$root/scripts/check-includes.sh" "$copy" 2>&1); then
        fail "not refused: $4"
    elif [[ $said != *"$1: "*"$3"* ]]; then
        fail "$4: refused, but without '$1: ... $3': $said"
    elif [[ $(wc -l <<<"$said") != 1 ]]; then
        fail "$4: more than one line: $said"
    else
        echo "refused: $4"
    fi
    cp "$copy/original" "$file"
}

rm -rf "$copy"
mkdir -p "$copy"
cp -r "$root/libs" "$root/apps" "$root/python" "$copy/"

"$root/scripts/check-includes.sh" "$copy" || fail "the sources as they are"
refused libs/hgmm/include/hgmm/map.h fusion/novelty.h 'a public header includes fusion/novelty.h' \
    'a public header that includes a private one'
refused libs/hgmm/include/hgmm/map.h hgmm/no_such_header.h 'no public header hgmm/no_such_header.h' \
    'a public header that does not exist'
refused libs/hgmm/src/mixture/em.cpp fusion/novelty.h 'mixture/ includes fusion/novelty.h, from above' \
    'a lower folder that includes an upper one'
refused libs/hgmm/src/base/lattice.h map/model.h 'base/ includes map/model.h, from above' \
    'the lowest folder that includes the highest'
refused libs/hgmm/src/map/insert.cpp mrpt/maps/CMetricMap.h "the core includes MRPT's" \
    'the core that includes MRPT'
refused libs/hgmm/include/hgmm/scan.h mrpt/maps/CMetricMap.h 'a public header includes mrpt/' \
    'a public header of the core that includes MRPT'
refused libs/mrpt-hgmm/src/map/map_file.cpp hgmm/evaluation/roc.h 'libs/mrpt-hgmm includes hgmm/evaluation/roc.h' \
    'the plugin that includes the evaluation library'
refused libs/evaluation/src/figures/roc.cpp CLI/CLI.hpp 'libs/evaluation includes CLI/CLI.hpp' \
    'the evaluation library that includes what belongs to programs'
refused python/src/saving.cpp mrpt/maps/CMetricMap.h 'python includes mrpt/' \
    'the Python package that includes MRPT'

mkdir "$copy/libs/hgmm/src/misc"
if said=$("$root/scripts/check-includes.sh" "$copy" 2>&1); then
    fail 'not refused: a folder that has no place in the pipeline'
elif [[ $said != *'libs/hgmm/src/misc'* ]]; then
    fail "a folder that has no place in the pipeline: $said"
fi
rm -rf "$copy"
exit $failed
