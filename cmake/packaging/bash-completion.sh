#!/usr/bin/env bash
# Writes what bash completes of programs in the current folder: their subcommands, and the options
# of each after a dash. All else are files.
#   bash-completion.sh FOLDER PROGRAM...
set -euo pipefail
source "$(dirname "$0")/subcommands.sh"
folder=$1
PATH=$PWD:$PATH
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

{
    cat <<'BASH'
# Made from what the programs print for --help.
_mrpt_hgmm() {
    local word=${COMP_WORDS[COMP_CWORD]} command=${1##*/} words=
    [[ $COMP_CWORD -eq 1 ]] || command+=" ${COMP_WORDS[1]}"
    case $command in
BASH
    for program in "${@:2}"; do
        subcommands=$(subcommandsOf "$program")
        for subcommand in $subcommands; do
            echo "    '$program $subcommand') words='$(optionsOf "$program" "$subcommand" | xargs)' ;;"
        done
        echo "    $program | '$program '*) words='$(echo $subcommands $(optionsOf "$program"))' ;;"
    done
    cat <<'BASH'
    esac
    # Subcommands come before the options. Where nothing fits, bash completes files.
    [[ $word == -* ]] || words=${words%%-*}
    COMPREPLY=($(compgen -W "$words" -- "$word"))
}
BASH
    echo "complete -o default -F _mrpt_hgmm ${*:2}"
} >"$2"
for program in "${@:3}"; do ln -s "$2" "$program"; done
