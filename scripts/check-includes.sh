#!/usr/bin/env bash
# Checks who includes whom:
#   - public headers of the core include public headers of the core, Eigen and the standard library only,
#   - folders of libs/hgmm/src include folders below them in the list here only,
#   - the core includes nothing of MRPT; libraries and apps include only what is below them.
#   scripts/check-includes.sh [FOLDER]    FOLDER: the repository, the default, or a copy of it
# Prints one line for each wrong include; exit code 1 if there is one.
set -euo pipefail
cd "${1:-$(dirname "$0")/..}"

# From the top of the pipeline to the bottom.
folders=(tracking map io cell_map registration modality occupancy fusion scan index mixture base)
wrong=0
complain() {
    printf '%s\n' "$*" >&2
    wrong=1
}
# Prints "file:include" of all includes in quotes or angle brackets below a folder.
includes() {
    grep -rHoE '^#include [<"][^>"]+[>"]' "$@" --include='*.h' --include='*.cpp' |
        sed -E 's/:#include [<"]/:/; s/[>"]$//'
}
declare -A rank=()
for i in "${!folders[@]}"; do rank[${folders[i]}]=$i; done

core=libs/hgmm
while IFS=: read -r file header; do
    case $header in
        hgmm/*)
            [[ -f $core/include/$header ]] || complain "$file: no public header $header" ;;
        Eigen/*) ;;
        */*) complain "$file: a public header includes $header, which is not public" ;;
        *.h) complain "$file: a public header includes $header, which is not public" ;;
    esac
done < <(includes $core/include)

for path in $core/src/*; do
    [[ -d $path && -n ${rank[${path##*/}]-} ]] ||
        complain "$path: no folder of the pipeline (scripts/check-includes.sh lists them)"
done
while IFS=: read -r file header; do
    from=${file#"$core/src/"} from=${from%%/*}
    to=${header%%/*}
    case $header in
        mrpt/*) complain "$file: the core includes MRPT's $header" ;;
        hgmm/*)
            [[ -f $core/include/$header ]] || complain "$file: no public header $header" ;;
        *.h)
            if [[ ! -f $core/src/$header ]]; then
                complain "$file: no header $header in the core"
            elif ((${rank[$to]:--1} < ${rank[$from]:--1})); then
                complain "$file: $from/ includes $header, from above it"
            fi ;;
    esac
done < <(includes $core/src)

# Which folders' headers a library or an app must not include, for these are above it.
above() {
    local folder=$1 pattern=$2
    while IFS=: read -r file header; do
        [[ $header =~ $pattern ]] && complain "$file: $folder includes $header, from above it"
    done < <(includes "$folder")
    return 0
}
# Of a function in a header the linker keeps one, maybe that of an instruction set which the processor
# does not have: what is compiled for one includes nothing but plain arrays.
for file in $core/src/*/*_kernel.h $core/src/*/*_kernel_loops.h $core/src/*/*_avx2.cpp; do
    ! grep -q '#include <' "$file" || complain "$file: is compiled for one instruction set, and includes more"
done
above libs/hgmm '^(hgmm/(evaluation|slam|mrpt_bridge)|nlohmann|CLI)/'
above libs/mrpt-hgmm '^(hgmm/(evaluation|slam)|nlohmann|CLI)/'
above libs/slam '^(hgmm/evaluation|nlohmann|CLI)/'
above libs/evaluation '^(hgmm/slam|CLI)/'
above python '^(mrpt|hgmm/(evaluation|slam|mrpt_bridge)|nlohmann|CLI)/'
exit $wrong
