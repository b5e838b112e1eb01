"""The plots of a report as data: what metrics.json holds, curve by curve."""
import math
from typing import NamedTuple, Optional

MOST_INSERTIONS = 300
"""points of a curve of insertion times"""


class Curve(NamedTuple):
    """A line of a plot."""

    points: list
    """(x, y), in drawing order"""
    label: str = ""
    """in the legend; a curve without one is a grey backdrop"""
    emphasised: bool = False
    markers: bool = False
    style: Optional[int] = None
    """number of its colour, dashes and mark; None: its place among labelled curves"""


class Plot(NamedTuple):
    """A plot with labelled axes."""

    title: str
    x_label: str
    y_label: str
    curves: list
    caption: str = ""
    x_logarithmic: bool = False
    y_logarithmic: bool = False


def curve_of(number, map_, points, **look):
    """The curve of a map: it looks the same in every plot, and the first map's is thick."""
    return Curve(points, map_["name"], emphasised=number == 0, style=number, **look)


def finite(points, above=-math.inf):
    """The points that can be drawn: metrics.json has null for what is not finite."""
    return [(x, y) for x, y in points if x is not None and y is not None and y > above]


DIAGONAL = Curve([(0, 0), (1, 1)])


def roc_near(maps):
    curves = [curve_of(i, m, finite(m["roc_near"])) for i, m in enumerate(maps) if "roc_near" in m]
    return Plot("Hits or free points near them", "false positive rate", "true positive rate",
                [DIAGONAL, *curves],
                "Receiver operating characteristic against free points close before the hit, the "
                "hard ones. Grey: guessing.")


def roc_uniform(maps):
    curves = [curve_of(i, m, finite(m["tpr_at_log_fpr"]))
              for i, m in enumerate(maps) if "tpr_at_log_fpr" in m]
    guessing = Curve([(10 ** (k / 25), 10 ** (k / 25)) for k in range(-100, 1)])
    return Plot("Hits or free points anywhere", "false positive rate", "true positive rate",
                [guessing, *curves],
                "The same against free points anywhere along the ray; as maps mistake few of "
                "them, the false positive rate is logarithmic.", x_logarithmic=True)


def reliability(maps):
    curves = [curve_of(i, m, finite(m["reliability"]), markers=True)
              for i, m in enumerate(maps) if "reliability" in m]
    return Plot("Reliability: hits and near free points 1:1, in bins of equal mass",
                "P(occupied) of the map, mean of the bin", "occupied share of the bin",
                [DIAGONAL, *curves],
                "On the grey diagonal, probabilities are what they claim to be; above it, maps "
                "are too cautious about what is occupied.")


def counted_bytes(map_):
    """Saved, or what is held where a map cannot be saved."""
    return map_.get("bytes_serialized") or map_["bytes_live"]


def levels(maps):
    curves = []
    for i, map_ in enumerate(maps):
        points = [(level["bytes"] / 1000, level.get("auc_near"))
                  for level in map_["levels"] if level["bytes"] > 0]
        if not map_["levels"] and "auc_near" in map_:
            points = [(counted_bytes(map_) / 1000, map_["auc_near"])]
        curves.append(curve_of(i, map_, finite(points), markers=True))
    return Plot("Accuracy against memory (levels of the hierarchy joined)", "memory [KB]",
                "AUC, near free points", curves,
                "Further left is smaller, higher is better. Levels of one hierarchy are joined, "
                "from the base on the right; they count what they take when saved, as do other "
                "maps that can be; the rest count by their own account.", x_logarithmic=True)


def spans_decades(curves):
    """Whether only a logarithmic axis shows all curves."""
    values = [y for curve in curves for _, y in curve.points]
    return bool(values) and max(values) > 30 * min(values)


def median(values):
    ordered = sorted(values)
    middle = len(ordered) // 2
    return ordered[middle] if len(ordered) % 2 else (ordered[middle - 1] + ordered[middle]) / 2


def insertion(maps):
    scans = max((len(m["scan_ms"]) for m in maps), default=0)
    group = max(1, math.ceil(scans / MOST_INSERTIONS))
    curves = []
    for number, map_ in enumerate(maps):
        times = map_["scan_ms"]
        points = [(i + 1 + (len(times[i:i + group]) - 1) / 2, median(times[i:i + group]))
                  for i in range(0, len(times), group)]
        curves.append(curve_of(number, map_, finite(points, above=0)))
    label = "insertion [ms]" if group == 1 else f"insertion, median of {group} [ms]"
    return Plot("Time to insert a scan", "mapping scan [number]", label, curves,
                "Below is faster; a rise is the price of a map that grows.",
                y_logarithmic=spans_decades(curves))


def memory(maps):
    curves = [curve_of(i, m, finite([(scans, size / 1000)
                                     for scans, size in m["bytes_live_over_run"]], above=0))
              for i, m in enumerate(maps)]
    return Plot("Live memory over the run", "mapping scans inserted [number]", "live memory [KB]",
                curves, "By each map\u2019s own account, while it was built.",
                y_logarithmic=spans_decades(curves))


def studied(plot):
    """A plot that a study put into metrics.json."""
    curves = [Curve(finite(c["points"]), c.get("label", ""), c.get("emphasised", False)) for c in plot["curves"]]
    return Plot(plot["title"], plot["x_label"], plot["y_label"], curves)


def plots_of(metrics):
    """All plots that have a curve to show."""
    maps = metrics.get("maps", [])
    plots = [make(maps) for make in (roc_near, roc_uniform, reliability, levels, insertion, memory)]
    plots += [studied(plot) for plot in metrics.get("plots", [])]
    return [p for p in plots if any(c.label and c.points for c in p.curves)]
