# shellcheck shell=bash
# Stages one after the other, for scripts that source this.
#   stage NAME COMMAND...   announces the stage, runs the command, ends the script if it fails
# At the end, also after a failure, a table says what each stage took: by the clock, and of all cores.
stageTable=()
stageStart=$SECONDS
stageTimes=$(mktemp)

stage() {
    local name=$1 clock=$SECONDS code before line
    shift
    printf '\n=== %s ===\n' "$name"
    coreSeconds
    before=$coreSeconds
    # In a shell of its own, where a line that fails ends the stage.
    set +e
    (
        set -e
        "$@"
    )
    code=$?
    set -e
    coreSeconds
    line=$(printf '%-40s %6d s %6d s' "$name" $((SECONDS - clock)) $((coreSeconds - before)))
    ((code == 0)) || line+='   FAILED'
    stageTable+=("$line")
    printf '=== %s: %d s ===\n' "$name" $((SECONDS - clock))
    ((code == 0)) || exit "$code"
}

# Sets coreSeconds to what the children of this shell took until now.
coreSeconds() {
    times >"$stageTimes"  # not in a shell of its own, which has no children yet
    coreSeconds=$(awk -F'[ms ]+' 'NR == 2 { printf "%d", 60 * ($1 + $3) + $2 + $4 }' "$stageTimes")
}

printStages() {
    rm -f "$stageTimes"
    printf '\n%-40s %8s %8s\n' stage clock cores
    printf '%s\n' "${stageTable[@]}"
    printf '%-40s %6d s\n' all $((SECONDS - stageStart))
}
trap printStages EXIT
