#!/usr/bin/env bash
# Installs the packages that scripts/package.sh has made, uses each, removes all, and compares the files
# of the system before and after. For a bare system that may be thrown away; as root.
#   scripts/try-packages.sh FOLDER      where the packages are
# scripts/test-in-debian.sh runs it. The lists of files are written beside the packages.
set -euo pipefail
cd "$(dirname "$0")/.."
debs=$(realpath "$1")
work=$(mktemp -d)
export DEBIAN_FRONTEND=noninteractive

fail() {
    echo "try-packages.sh: $*" >&2
    exit 1
}
say() { echo "ok: $*"; }

# All files of the system, but what is mounted, this tree and what the trials make.
files() {
    find / -xdev \( -path "$PWD" -o -path "$debs" -o -path "$work" -o -path /data -o -path /ccache \
        -o -path /var/cache/apt/archives \) -prune -o -print | sort
}

packages=()
for deb in "$debs"/*.deb; do packages+=("$(dpkg-deb -f "$deb" Package)"); done
debOf() { echo "$debs/$1"_*.deb; }

expected=$debs/files-before.txt
# Packages of others. What they bring belongs to the system.
getOthers() { # PACKAGE...
    [[ $# -gt 0 ]] || return 0
    files >"$work/before"
    apt-get install -y -qq --no-install-recommends "$@" >"$work/apt.log" 2>&1 ||
        { tail -20 "$work/apt.log"; fail "apt-get install $*"; }
    files | comm -13 "$work/before" - | sort -o "$expected" - "$expected"
}

# First what others have of what our packages need, and then those alone: nothing that they need
# comes from elsewhere.
get() { # PACKAGE...
    local package wanted=() others
    for package in "$@"; do wanted+=("$(debOf "$package")"); done
    others=$(apt-get install -s --no-install-recommends "${wanted[@]}" |
        awk '$1 == "Inst" { print $2 }' | grep -vxF "$(printf '%s\n' "${packages[@]}")") || true
    getOthers $others
    apt-get install -y -qq --no-install-recommends "${wanted[@]}" >"$work/apt.log" 2>&1 ||
        { tail -20 "$work/apt.log"; fail "apt-get install ${wanted[*]}"; }
}

programs() { dpkg -L "$1" | grep '^/usr/bin/.' | xargs -n 1 basename; }

# What its --help lists has a page, and is completed.
triesProgram() { # PROGRAM
    local program=$1 subcommand
    [[ $("$program" --version) =~ ^$program\ [0-9.]+$ ]] || fail "$program --version"
    [[ -f /usr/share/man/man1/$program.1.gz ]] || fail "no man page of $program"
    triesCompletion "$program"
    for subcommand in $("$program" --help | awk '/^Subcommands:/ { on = 1; next } /^$/ { on = 0 } on && /^  [a-z0-9]/ { print $1 }'); do
        [[ -f /usr/share/man/man1/$program-$subcommand.1.gz ]] || fail "no man page of $program $subcommand"
        [[ " $(completed "$program" "${subcommand:0:2}") " == *" $subcommand "* ]] ||
            fail "bash does not complete $program $subcommand"
        triesCompletion "$program" "$subcommand"
    done
    say "$("$program" --version), its man pages and completion"
}

completed() { # WORD...      what fits the last of them
    bash -c 'source "/usr/share/bash-completion/completions/$1"
        COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)); _mrpt_hgmm "$1"; echo "${COMPREPLY[@]}"' completed "$@"
}

triesCompletion() { # PROGRAM [SUBCOMMAND]
    diff <("$@" --help | grep -oE '^  (-[a-zA-Z],)?--[^ ]+' | grep -oE -- '--[a-z0-9-]+' | sort -u) \
        <(completed "$@" -- | tr ' ' '\n' | sort -u) || fail "bash completes other options of $*"
}

# A block of a page, the first in that language.
blockOf() { # LANGUAGE PAGE
    awk -v fence="^\`\`\`$1\$" '$0 ~ fence { on = 1; next } on && /^```/ { exit } on' "$2"
}

triesTools() {
    local program data=/usr/share/mrpt/datasets
    for program in $(programs mrpt-hgmm-tools); do triesProgram "$program"; done
    if ldd $(dpkg -L "${packages[@]}" 2>/dev/null | grep -E '^/usr/bin/.|\.so') 2>/dev/null | grep 'not found'; then
        fail "libraries are missing"
    fi
    getOthers mrpt-common
    hgmm-replay "$data/tests_rgbd.rawlog" --quiet --save-map "$work/map.hgmm" >/dev/null
    hgmm-map query "$work/map.hgmm" 0.8,0,0 | grep -q free || fail "hgmm-map query"
    say "a map of a recording"
}

triesPython() {
    blockOf python README.md >"$work/x.py"
    (cd "$work" && python3 x.py | grep -qE '\[(1\.|0\.[5-9])') || fail "the README's program in Python"
    (cd "$work" && python3 -c 'import hgmm; print(hgmm.__version__, hgmm.__file__)')
    say "Python"
}

triesCore() {
    blockOf cpp README.md >"$work/x.cpp"
    g++ -std=c++17 "$work/x.cpp" -o "$work/x" $(pkg-config --cflags --libs hgmm)
    "$work/x" | grep -q '^occupied 0' || fail "the README's program, by pkg-config"
    cmake -S tests/install/core_consumer -B "$work/core" >/dev/null
    cmake --build "$work/core" >/dev/null
    "$work/core/consumer-core" | grep -qE ': [1-9][0-9]* component' || fail "the core, by CMake"
    say "a program with libhgmm-dev, by pkg-config and by CMake"
}

triesPlugin() {
    blockOf cpp docs/use-in-your-app.md >"$work/y.cpp"
    g++ -std=c++17 "$work/y.cpp" -o "$work/y" $(pkg-config --cflags --libs mrpt-hgmm)
    (cd "$work" && ./y | grep -q 'P(occupied) = 0.[5-9]') || fail "the page's program, by pkg-config"
    cmake -S tests/install/consumer -B "$work/plugin" -DDOCUMENTED="$work/y.cpp" >/dev/null
    cmake --build "$work/plugin" >/dev/null
    "$work/plugin/consumer-plugin" | grep -qE ': [1-9][0-9]* component' || fail "the plugin, by CMake"
    say "a program with libmrpt-hgmm-dev, by pkg-config and by CMake"
}

triesBuilder() {
    g++ -std=c++17 tests/install/builder_consumer/builder.cpp -o "$work/z" \
        $(pkg-config --cflags --libs mrpt-hgmm-builder)
    "$work/z" >/dev/null || fail "the map builder, by pkg-config"
    cmake -S tests/install/builder_consumer -B "$work/builder" >/dev/null
    cmake --build "$work/builder" >/dev/null
    "$work/builder/consumer-builder" | grep -qE ': [1-9][0-9]* keyframe' || fail "the map builder, by CMake"
    say "a program with libmrpt-hgmm-builder-dev, by pkg-config and by CMake"
}

triesStockPrograms() {
    local config=/usr/share/mrpt-hgmm/config_files/pf-localization.ini
    (cd "$work" && LD_PRELOAD=libmrpt-hgmm.so.0 timeout 200 pf-localization $config </dev/null >log 2>&1) ||
        { tail -5 "$work/log"; fail "pf-localization"; }
    grep 'PDF estimation' "$work/log" | tail -1 | grep -E '\(1[56]\.[0-9]*,-(9|10)\.' ||
        fail "pf-localization ended elsewhere: $(grep 'PDF estimation' "$work/log" | tail -1)"
    say "stock pf-localization with the plugin"
}

triesRemoval() {
    apt-get purge -y -qq "${packages[@]}" >"$work/apt.log" 2>&1
    files >"$debs/files-after.txt"
    # A folder that others have, too, is theirs.
    comm -13 "$expected" "$debs/files-after.txt" | while read -r path; do
        dpkg-query -S "$path" >/dev/null 2>&1 || echo "$path"
    done >"$work/left"
    [[ ! -s $work/left ]] || fail "left after removal: $(cat "$work/left")"
    comm -23 "$expected" "$debs/files-after.txt" >"$work/gone"
    [[ ! -s $work/gone ]] || fail "removed with the packages: $(cat "$work/gone")"
    ! ldconfig -p | grep hgmm || fail "ldconfig still knows of libraries"
    say "$(wc -l <"$debs/files-after.txt") files after removal, as before"
}

apt-get update -qq
files >"$expected"
getOthers ca-certificates
get mrpt-hgmm-tools libmrpt-hgmm0 libhgmm0
triesTools
get python3-hgmm
triesPython
get libhgmm-dev
getOthers g++ cmake make pkg-config
triesCore
get libmrpt-hgmm-dev
triesPlugin
get libmrpt-hgmm-builder0 libmrpt-hgmm-builder-dev
triesBuilder
getOthers mrpt-apps
triesStockPrograms
triesRemoval
rm -rf "$work"
