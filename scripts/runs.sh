# Sourced by scripts that compare maps over many runs. $out/runs.txt has a line for each run that
# ended: the map, then its figures. Lines of other lengths are failures.

# The middle of a column of numbers, the mean of the middle two if there is no one.
median() {
    sort -g | awk '{ v[NR] = $1 } END { if (NR) print NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'
}

# figures MAP COUNT COLUMN: a column of the map's runs, which have COUNT columns.
figures() {
    awk -v map="$1" -v count="$2" -v column="$3" '$1 == map && NF == count { print $column }' "$out/runs.txt"
}

# successes MAP COUNT METRES DEGREES: how many runs have figures 2 and 3 within these limits.
successes() {
    awk -v map="$1" -v count="$2" -v metres="$3" -v degrees="$4" \
        '$1 == map && NF == count && $2 <= metres && $3 <= degrees { ++n } END { print n + 0 }' "$out/runs.txt"
}
