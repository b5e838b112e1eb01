"""The tables of a report: a row for each map, the best in bold."""
import html
from typing import Callable, NamedTuple

DASH = "\u2013"
NEAR = "near free points"
ARROWS = ("", "\u00a0\u2191", "\u00a0\u2193")
WHY_NOT_RANKED = {
    "surface_likelihood":
        "its answer is a likelihood of surfaces, not a probability of occupancy",
    "nearness":
        "its answer tells how near a measured point is, not a probability of occupancy",
}


class Column(NamedTuple):
    heading: str
    unit: str
    best: int
    """1: the highest is best, -1: the lowest, 0: none is"""
    digits: int
    value: Callable
    """of a map's entry in metrics.json: a number, or None"""

    def text(self, map_):
        value = self.value(map_)
        return DASH if value is None else f"{value:.{self.digits}f}"


def entry(key, scale=1.0):
    def value(map_):
        return None if map_.get(key) is None else scale * map_[key]
    return value


def time(key):
    return lambda map_: map_[key] if map_["scan_ms"] else None


ACCURACY = (
    Column("AUC", "uniform free points", 1, 4, entry("auc_uniform")),
    Column("AUC", NEAR, 1, 4, entry("auc_near")),
    Column("TPR at 5 % FPR", NEAR, 1, 4, entry("tpr_at_fpr_5pct_near")),
    Column("Balanced accuracy", NEAR, 1, 4, entry("balanced_accuracy_near")),
    Column("Brier score", NEAR, -1, 4, entry("brier")),
    Column("ECE", NEAR, -1, 4, entry("ece")),
    Column("Unknown", "share of hits", 0, 3, entry("unknown_share_hit")),
    Column("Unknown", "of uniform free", 0, 3, entry("unknown_share_free")),
    Column("Unknown", "of near free", 0, 3, entry("unknown_share_near")),
)
COST = (
    Column("Saved", "KB", -1, 1, entry("bytes_serialized", 1e-3)),
    Column("Live", "KB", -1, 1, entry("bytes_live", 1e-3)),
    Column("Insertion, median", "ms/scan", -1, 2, time("scan_ms_median")),
    Column("99th percentile", "ms/scan", -1, 2, time("scan_ms_p99")),
    Column("Worst", "ms/scan", -1, 2, time("scan_ms_worst")),
    Column("First tenth", "ms/scan", 0, 2, time("scan_ms_first_tenth")),
    Column("Last tenth", "ms/scan", 0, 2, time("scan_ms_last_tenth")),
    Column("Queries", "thousands/s", 1, 0, entry("queries_per_s", 1e-3)),
)


def best_text(column, maps):
    """What the best of the ranked maps reads; None if there is none to compare."""
    ranked = [m for m in maps if m["ranked"] and column.value(m) is not None]
    if column.best == 0 or len(ranked) < 2:
        return None
    return column.text(max(ranked, key=lambda m: column.best * column.value(m)))


def row(map_, columns, best):
    cells = f'<tr><th scope="row">{html.escape(map_["name"])}'
    if not map_["ranked"]:
        cells += f'<small>{WHY_NOT_RANKED.get(map_["score"], "shown for comparison")}</small>'
    cells += "</th>"
    for column, best_of_column in zip(columns, best):
        text = column.text(map_)
        bold = map_["ranked"] and text == best_of_column
        cells += f"<td><b>{text}</b></td>" if bold else f"<td>{text}</td>"
    return cells + "</tr>\n"


def table(caption, maps, columns):
    """Maps that are not ranked stand below the others."""
    best = [best_text(column, maps) for column in columns]
    head = "".join(
        f'<th scope="col">{c.heading}{ARROWS[c.best]}'
        f"<small>{c.unit}</small></th>" for c in columns)
    text = (f'<h3>{caption}</h3>\n<div class="scroll" tabindex="0">\n'
            f'<table aria-label="{caption}">\n'
            f'<thead><tr><th scope="col">Map</th>{head}</tr></thead>\n<tbody>\n')
    text += "".join(row(m, columns, best) for m in maps if m["ranked"]) + "</tbody>\n"
    others = "".join(row(m, columns, best) for m in maps if not m["ranked"])
    if others:
        text += f'<tbody class="unranked">\n{others}</tbody>\n'
    return text + "</table>\n</div>\n"
