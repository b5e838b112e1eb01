# To be sourced: what a program's --help lists.

subcommandsOf() { # PROGRAM
    "$1" --help | sed -n '/^Subcommands:\|^SUBCOMMANDS:/,/^$/p' | sed -nE 's/^  ([a-z0-9-]+) .*/\1/p'
}

# Names of options, one a line, of "-o,--output FILE" and its like.
optionsOf() { # PROGRAM [SUBCOMMAND]
    "$@" --help | sed -nE 's/^  (-[^ ]*( +--[^ ]*)?).*/\1/p' | tr -s ', ' '\n\n' | grep '^-'
}
