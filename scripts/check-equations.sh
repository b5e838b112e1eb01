#!/usr/bin/env bash
# Compares the equation table of docs/method.md with the tags `thesis eq. (3.19)` in libs/ and apps/.
#   scripts/check-equations.sh              checks the table; a line for each fault, exit code 1 if there is one
#   scripts/check-equations.sh --write      writes the table's file column anew, then checks
#   scripts/check-equations.sh --self-test  plants faults in a copy and expects each to be refused
#
# A tag is `thesis eq. (3.19)`. Lists and ranges follow it: `(3.20), (3.21) and (3.22)`, `(3.19)-(3.22)`,
# `(3.19) to (3.22)`. It may run over the end of a comment line. `eq. (3.8)` with the parentheses is a tag
# as well, so cite other works without them: `Rasmussen and Williams, eq. 4.17`.
#
# The table has one row an equation: | (3.19) | description | files |. The description is written by hand. The
# file column is generated, but for equations without a tag: there it says `none: WHY`, written by hand.
# In all tables of the page, names in backticks must occur in the files of their row. Every source file that
# the page names must exist.
# shellcheck disable=SC2016  # backticks here are Markdown's
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")/.." && pwd)
page=docs/method.md
beginMark='<!-- equations: begin -->'
endMark='<!-- equations: end -->'

# sources ROOT FOLDER...: the source files below these folders.
sources() {
    (cd "$1" && shift && find "$@" -type f \( -name '*.h' -o -name '*.hpp' -o -name '*.cpp' \) 2>/dev/null | sort) || true
}

# tags ROOT: a line "EQUATION FILE" for each equation that a file cites; "? FILE TEXT" for a tag that cannot be read.
tags() {
    sources "$1" libs apps | (cd "$1" && xargs awk '
        function cite(c, n) { key = c "." n " " path; if (!(key in seen)) { seen[key] = 1; print key } }
        # The equations of one tag, "(3.19)-(3.22)" or "(5.12), (5.14)".
        function list(s,   c, n, lastN, sep) {
            lastN = 0
            while (match(s, /[0-9]\.[0-9]+/)) {
                sep = substr(s, 1, RSTART - 1)
                c = substr(s, RSTART, 1)
                n = substr(s, RSTART + 2, RLENGTH - 2) + 0
                if (lastN && sep ~ /-|–| to /)
                    while (++lastN < n) cite(c, lastN)
                cite(c, n)
                lastN = n
                s = substr(s, RSTART + RLENGTH)
            }
        }
        function finish(   s, t) {
            gsub(/[ \t]+/, " ", text)
            s = text
            while (match(s, /eqs?\. \([3-5]\.[0-9]+\)(( ?- ?|–|,? to |,? and |,? or |, )\([3-5]\.[0-9]+\))*/)) {
                t = substr(s, RSTART, RLENGTH)
                s = substr(s, RSTART + RLENGTH)
                list(t)
            }
            s = text
            while (match(s, /[Tt]hesis,? [Ee]q[^ ]* [^ ]*/)) {
                t = substr(s, RSTART, RLENGTH)
                s = substr(s, RSTART + RLENGTH)
                if (t ~ /^[Tt]hesis eqs?\. [3-5]\.[0-9]+/) list(t)
                else if (t !~ /^[Tt]hesis eqs?\. \([3-5]\.[0-9]+\)/) print "? " path " " t
            }
            text = ""
        }
        FNR == 1 { if (NR > 1) finish(); path = FILENAME }
        { sub(/^[ \t]*(\/\/[\/!]?<?|\*)?/, ""); text = text " " $0 }
        END { finish() }')
}

# rows ROOT: the rows of the table, "EQUATION|description|files".
rows() {
    awk -v begin="$beginMark" -v end="$endMark" '
        $0 == begin { inside = 1; next }
        $0 == end { inside = 0 }
        inside && /^\| \([0-9]+\.[0-9]+\) \|/ {
            split($0, cell, /[ ]*\|[ ]*/)
            gsub(/[()]/, "", cell[2])
            print cell[2] "|" cell[3] "|" cell[4]
        }' "$1/$page"
}

byEquation() { sort -t. -k1,1n -k2,2n; }

# links FILE...: as the table shows them, what computes before what declares.
links() {
    printf '%s\n' "$@" | awk '
        { rank = $0 ~ /^libs\/hgmm\/src\// ? 1 : $0 ~ /^libs\/hgmm\// ? 2 : 3; print rank, $0 }' | sort | awk '
        {
            label = $2
            sub(/^libs\/hgmm\/(src|include\/hgmm)\//, "", label)
            printf("%s[%s](../%s)", NR > 1 ? ", " : "", label, $2)
        }'
}

# load ROOT: descriptions, file columns and tags by equation.
load() {
    local root=$1 equation description files file
    for mark in "$beginMark" "$endMark"; do
        [[ $(grep -cxF -- "$mark" "$root/$page") == 1 ]] || { echo "$page: not exactly one line '$mark'" >&2; exit 1; }
    done
    declare -gA descriptionOf=() columnOf=() taggedIn=()
    unreadable=() twice=()
    while IFS='|' read -r equation description files; do
        [[ -z ${columnOf[$equation]+x} ]] || twice+=("$equation")
        descriptionOf[$equation]=$description
        columnOf[$equation]=$files
    done < <(rows "$root")
    while read -r equation file; do
        if [[ $equation == '?' ]]; then unreadable+=("$file"); else taggedIn[$equation]+="$file "; fi
    done < <(tags "$root")
}

# write ROOT: the table anew.
write() {
    local root=$1 table equation column
    load "$root"
    table=$(mktemp)
    {
        echo '| eq. | meaning, and who computes it | files |'
        echo '| --- | --- | --- |'
        for equation in $(printf '%s\n' "${!columnOf[@]}" "${!taggedIn[@]}" | sort -u | byEquation); do
            column=${columnOf[$equation]-}
            # shellcheck disable=SC2086  # a list of files without blanks
            [[ -z ${taggedIn[$equation]-} ]] || column=$(links ${taggedIn[$equation]})
            echo "| ($equation) | ${descriptionOf[$equation]-} | $column |"
        done
    } >"$table"
    awk -v begin="$beginMark" -v end="$endMark" -v table="$table" '
        $0 == begin { print; while ((getline line < table) > 0) print line; inside = 1 }
        $0 == end { inside = 0 }
        !inside { print }' "$root/$page" >"$table.page"
    cat "$table.page" >"$root/$page"
    rm "$table" "$table.page"
}

# equationFaults ROOT: what is wrong with the equation table.
equationFaults() {
    local root=$1 equation column tagged listed file
    load "$root"
    for file in "${unreadable[@]}"; do echo "${file%% *}: the tag '${file#* }' cannot be read: write it as thesis eq. (3.19)"; done
    for equation in "${twice[@]}"; do echo "$page: ($equation) has two rows"; done
    for equation in $(printf '%s\n' "${!taggedIn[@]}" | byEquation); do
        [[ -n ${columnOf[$equation]+x} ]] || echo "$page: ($equation) has no row; it is tagged in ${taggedIn[$equation]% }"
    done
    for equation in $(printf '%s\n' "${!columnOf[@]}" | byEquation); do
        column=${columnOf[$equation]} tagged=" ${taggedIn[$equation]-}"
        [[ -n ${descriptionOf[$equation]} ]] || echo "$page: ($equation) has no description"
        listed=" $(grep -oE '\]\(\.\./[^)]*\)' <<<"$column" | sed 's/^](..\///; s/)$//' | tr '\n' ' ' || true)"
        for file in $listed; do
            if [[ ! -f $root/$file ]]; then
                echo "$page: ($equation): $file does not exist"
            elif [[ $tagged != *" $file "* ]]; then
                echo "$page: ($equation): $file has no tag 'thesis eq. ($equation)'"
            fi
        done
        for file in $tagged; do
            [[ $listed == *" $file "* ]] || echo "$page: ($equation): $file has its tag but is not listed"
        done
        if [[ $tagged == ' ' && $column != 'none: '?* ]]; then
            echo "$page: ($equation): no source has its tag; tag the code, or write 'none: WHY' into the file column"
        fi
    done
}

# nameFaults ROOT: file names on the page that do not exist, and names in tables that their row's files do not have.
nameFaults() {
    local root=$1 all number line token files tokens part missing
    all=$(sources "$root" libs apps tests bench)
    while IFS=: read -r number line; do
        files=() tokens=()
        while read -r token; do
            if [[ $token == '](../'* ]]; then
                token=${token#'](../'}
                [[ ! -f $root/${token%)} ]] || files+=("$root/${token%)}")
                continue
            fi
            token=${token//\`/}
            if [[ $token == *.h || $token == *.cpp ]]; then
                missing=1
                while read -r part; do files+=("$root/$part"); missing=0; done < <(grep -E "(^|/)${token//./\\.}$" <<<"$all" || true)
                [[ $missing == 0 ]] || echo "$page:$number: there is no file $token"
            elif [[ $token =~ ^[A-Za-z_][A-Za-z0-9_]*(::[A-Za-z_][A-Za-z0-9_]*)*$ ]]; then
                tokens+=("$token")
            fi
        done < <(grep -oE '`[^` ]*`|\]\(\.\./[^)]*\.(h|cpp)\)' <<<"$line")
        [[ $line == '|'* && ${#files[@]} -gt 0 ]] || continue
        for token in "${tokens[@]}"; do
            for part in ${token//::/ }; do
                grep -qwF -- "$part" "${files[@]}" || { echo "$page:$number: \`$token\` is in none of the files of its row"; break; }
            done
        done
    done < <(grep -nE '`[^` ]*\.(h|cpp)`|\]\(\.\./[^)]*\.(h|cpp)\)' "$root/$page")
}

check() {
    local faults
    faults=$(equationFaults "$1" && nameFaults "$1")
    [[ -n $faults ]] || return 0
    printf '%s\n' "$faults" >&2
    echo "File columns are written anew by scripts/check-equations.sh --write; the rest is for hands." >&2
    return 1
}

selfTest() {
    local said failed=0 victim
    copy=$(mktemp -d)  # not local: the trap runs when this function is over
    trap 'rm -rf "$copy"' EXIT
    fresh() {
        rm -rf "${copy:?}/"*
        mkdir -p "$copy/docs"
        cp -r "$here/libs" "$here/apps" "$here/tests" "$here/bench" "$copy/"
        cp "$here/$page" "$copy/$page"
    }
    # Reads to the end: a pipe that is closed early would end the script.
    fileOf() { tags "$copy" | awk -v eq="$1" '$1 == eq && !found { print $2; found = 1 }'; }
    # expect WORDS WHAT: the check must refuse the copy and say WORDS.
    expect() {
        if said=$(check "$copy" 2>&1); then
            echo "self-test: not refused: $2"; failed=1
        elif ! grep -qF -- "$1" <<<"$said"; then
            printf 'self-test: %s: refused, but without the words "%s":\n%s\n' "$2" "$1" "$said"; failed=1
        else
            echo "refused: $2"
        fi
    }

    fresh
    check "$copy" || { echo "self-test: the page itself is stale" >&2; return 1; }
    sed -i '/^| (3\.14) |/s|(\.\./[^)]*)|(../libs/hgmm/CMakeLists.txt)|' "$copy/$page"
    expect "libs/hgmm/CMakeLists.txt has no tag 'thesis eq. (3.14)'" "a row that names a file without the tag"
    fresh
    sed -i '/^| (3\.14) |/s|(\.\./[^)]*)|(../libs/hgmm/gone.cpp)|' "$copy/$page"
    expect "(3.14): libs/hgmm/gone.cpp does not exist" "a row that names a file that does not exist"
    fresh
    victim=$(fileOf 4.19)
    sed -i 's/eq\. (4\.19)/equation/' "$copy/$victim"
    expect "(4.19): $victim has no tag" "a tag that is gone"
    fresh
    echo '// thesis eq. (3.97) to (3.99)' >>"$copy/$victim"
    expect "(3.98) has no row" "a tagged range without rows"
    fresh
    printf '/// as thesis\n/// eq. (4.19)\n' >"$copy/apps/more.h"
    expect "(4.19): apps/more.h has its tag but is not listed" "a tag over the end of a line, not listed"
    fresh
    echo '// thesis equation 4.19' >>"$copy/$victim"
    expect "cannot be read" "a tag that cannot be read"
    fresh
    sed -i '/^| (3\.23) |/d' "$copy/$page"
    expect "(3.23) has no row" "a row that is gone"
    fresh
    sed -i '/^| (3\.14) |/s/| (3\.14) | /&`noSuchFunction`: /' "$copy/$page"
    expect '`noSuchFunction` is in none of the files of its row' "a function that is gone"
    fresh
    echo 'See `no_such_file.h`.' >>"$copy/$page"
    expect "there is no file no_such_file.h" "a file name in the text"
    fresh
    mkdir -p "$copy/apps/moved"
    mv "$copy/$victim" "$copy/apps/moved/"
    expect "$victim does not exist" "a file that has moved"
    write "$copy"
    if check "$copy" && grep -qF "apps/moved/$(basename "$victim")" "$copy/$page"; then
        echo "written anew: the file that has moved"
    else
        echo "self-test: --write did not follow the file that has moved"; failed=1
    fi
    # An equation of another work is no tag.
    if [[ $(tags "$copy") == *gp_octomap* ]]; then echo "self-test: another work's equation counts"; failed=1; fi
    return "$failed"
}

case ${1:-} in
    '') check "$here" ;;
    --write) write "$here" && check "$here" ;;
    --self-test) selfTest ;;
    *) echo "usage: $0 [--write | --self-test]" >&2; exit 2 ;;
esac
