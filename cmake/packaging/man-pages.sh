#!/usr/bin/env bash
# Writes compressed man pages of programs in the current folder, by help2man: one for each program
# and one for each of its subcommands.
#   man-pages.sh VERSION FOLDER PROGRAM...
set -euo pipefail
source "$(dirname "$0")/subcommands.sh"
version=$1
folder=$2
PATH=$PWD:$PATH
rm -rf "$folder"
mkdir -p "$folder"

# What whatis says: the first sentence of what --help says.
nameOf() { # COMMAND...
    "$@" --help | head -1 | sed -E 's/\. .*|\.$//; s/^[A-Z][a-z]/\l&/'
}

page() { # SEE_ALSO COMMAND...
    local command=${*:2} name
    name=${command// /-}
    help2man --no-info --version-string="$version" --name="$(nameOf "${@:2}")" \
        --include=<(printf '[SEE ALSO]\n%s\n' "$1") "$command" |
        sed -E "s/^\.TH [^ ]+/.TH ${name^^}/; s/^${command} \\\\-/${name} \\\\-/;
            s/^(\\\\fB\\\\-.\\\\fR),(\\\\-\\\\-[^ ]+)/\1, \\\\fB\2\\\\fR/" |
        gzip -9n >"$folder/$name.1.gz"
}

for program in "${@:3}"; do
    also=
    for subcommand in $(subcommandsOf "$program"); do
        page ".BR $program (1)" "$program" "$subcommand"
        also+=".BR $program-$subcommand (1),"$'\n'
    done
    also=${also%,$'\n'}
    page "${also:-The documentation in /usr/share/doc/mrpt-hgmm-tools}" "$program"
done
