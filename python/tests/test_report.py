"""What the report of a run says, from its metrics.json."""
import json
import re
import subprocess
import sys

import numpy
import pytest

pytest.importorskip("matplotlib")

from hgmm.report import make_report, plots_of  # noqa: E402
from hgmm.report.drawing import svg_of, view_axes  # noqa: E402
from hgmm.report.plots import insertion, levels  # noqa: E402


def example_map(name, auc, **more):
    """An entry of `maps`, as metrics_json.cpp writes it."""
    return {"name": name, "class": f"class::of::{name}", "source": f"Paper about {name}",
            "score": "occupancy", "ranked": True, "options": {"resolution_m": 0.05},
            "auc_uniform": auc, "auc_near": auc, "tpr_at_fpr_5pct_near": auc,
            "balanced_accuracy_near": auc, "brier": 1 - auc, "ece": 1 - auc,
            "unknown_share_hit": 0.01, "unknown_share_free": 0.02, "unknown_share_near": 0.03,
            "queries_per_s": 1e6 * auc, "roc_near": [[0, 0], [0.1, auc], [1, 1]],
            "tpr_at_log_fpr": [[1e-4, 0.1], [1e-2, auc], [1, 1]],
            "reliability": [[0.1, 0.2], [0.5, 0.4], [0.9, 0.7]], "bytes_live": 2000000,
            "scan_ms": [10, 12, 11], "scan_ms_median": 11, "scan_ms_p99": 12,
            "scan_ms_worst": 12, "scan_ms_first_tenth": 10, "scan_ms_last_tenth": 11,
            "bytes_live_over_run": [[1, 1000000], [3, 2000000]], "levels": [], **more}


def example_metrics(*maps, **protocol):
    return {"dataset": {"name": "kitchen <1>", "scans_mapped": 225, "scans_tested": 25,
                        "points_per_scan": 400.4, "sensor": "CObservation3DRangeScan"},
            "protocol": {"split": 10, "subsample": 1.0, "holdout_points": 0.0,
                         "queries_per_scan": 2000, "seed": 42, "near_m": [0.05, 0.3],
                         "free_band_m": [0.1, 0.15], "range_noise_m": 0.0, "threads": 2,
                         **protocol},
            "maps": list(maps)}


@pytest.fixture
def report_of(tmp_path):
    def make(metrics, **more):
        (tmp_path / "metrics.json").write_text(json.dumps(metrics))
        return make_report(tmp_path, **more)
    return make


def cells(page, table, name):
    """The cells of a map's row in the n-th table, tags and all."""
    body = re.findall("<table.*?</table>", page, re.DOTALL)[table]
    row = re.search(f'<tr><th scope="row">{name}<.*?</tr>', body, re.DOTALL).group(0)
    return re.findall("<td>(.*?)</td>", row)


def test_it_tells_what_was_run(report_of):
    page = report_of(example_metrics(example_map("ours", 0.9)))
    for part in ("<h1>kitchen &lt;1&gt;</h1>", "225 mapped, 25 tested, 400 points each",
                 "one scan of 10 tests the maps", "0.05 to 0.3 m before the hit", "<dd>42</dd>",
                 "2 for the first map", "class::of::ours", "resolution_m = 0.05"):
        assert part in page
    assert "interrupted" not in page and "held out" not in page
    metrics = example_metrics(example_map("ours", 0.9), holdout_points=0.2, subsample=0.1)
    metrics["dataset"]["interrupted"] = True
    page = report_of(metrics)
    assert "interrupted" in page and "20 % of the points" in page and "10 % of each" in page


def test_the_best_of_ranked_maps_is_in_bold(report_of):
    page = report_of(example_metrics(
        example_map("ours", 0.95, brier=0.1), example_map("tied", 0.95001, brier=0.2),
        example_map("worse", 0.8, brier=0.05, bytes_live=1000),
        example_map("nearest", 0.99, brier=None, ranked=False, score="nearness", bytes_live=10)))
    ours, tied, worse, nearest = (cells(page, 0, n) for n in ("ours", "tied", "worse", "nearest"))
    # Equal as printed, so both are best; the one that is not ranked leads but does not compete.
    assert ours[0] == tied[0] == "<b>0.9500</b>" and worse[0] == "0.8000"
    assert nearest[0] == "0.9900" and nearest[4] == "\u2013"
    assert worse[4] == "<b>0.0500</b>" and ours[4] == "0.1000"
    assert cells(page, 1, "worse")[1] == "<b>1.0</b>" and cells(page, 1, "nearest")[1] == "0.0"
    assert "its answer tells how near" in page
    assert page.index(">worse<") < page.index(">nearest<")


def test_without_test_points_there_is_no_accuracy(report_of):
    bare = {k: v for k, v in example_map("ours", 0.9).items()
            if not re.match("auc|tpr|roc|balanced|brier|ece|unknown|queries|reliab", k)}
    page = report_of(example_metrics(bare))
    assert "accuracy was not measured" in page and page.count("<table") == 1
    assert [p.title for p in plots_of(example_metrics(bare))] == [
        "Time to insert a scan", "Live memory over the run"]


def curve(plot, label):
    return next(c for c in plot.curves if c.label == label)


def test_curves_hold_the_figures():
    hierarchy = [{"level": 0, "bytes": 4000, "auc_near": 0.9},
                 {"level": 1, "bytes": 2000, "auc_near": 0.8}, {"level": 2, "bytes": 1000}]
    maps = [example_map("ours", 0.9, levels=hierarchy, bytes_serialized=7000),
            example_map("grid", 0.7, bytes_serialized=3000, scan_ms=[0.1, 0, None, 0.3])]
    plots = {p.title: p for p in plots_of(example_metrics(*maps))}
    assert len(plots) == 6
    assert curve(plots["Hits or free points near them"], "grid").points[1] == (0.1, 0.7)
    assert curve(plots["Hits or free points anywhere"], "ours").points[0] == (1e-4, 0.1)
    assert curve(levels(maps), "ours").points == [(4, 0.9), (2, 0.8)]
    assert curve(levels(maps), "grid").points == [(3, 0.7)]
    assert curve(plots["Live memory over the run"], "ours").points == [(1, 1000), (3, 2000)]
    # Zero and null cannot be drawn on the axis that shows both maps.
    assert curve(insertion(maps), "grid").points == [(1, 0.1), (4, 0.3)]
    assert insertion(maps).y_logarithmic and not insertion(maps[:1]).y_logarithmic


def test_long_runs_are_medians_of_consecutive_scans():
    plot = insertion([example_map("ours", 0.9, scan_ms=[float(i % 3) + 1 for i in range(900)])])
    assert "median of 3" in plot.y_label
    assert plot.curves[0].points[:2] == [(2, 2), (5, 2)] and len(plot.curves[0].points) == 300


def test_each_plot_is_drawn_and_nothing_clashes(report_of):
    metrics = example_metrics(example_map("ours", 0.9), example_map("$x_1$ & <b>", 0.8))
    page = report_of(metrics)
    svgs = re.findall("<svg.*?</svg>", page, re.DOTALL)
    assert len(svgs) == 6 and all("ours" in svg and "$x_1$ &amp; &lt;b&gt;" in svg for svg in svgs)
    ids = re.findall(r' id="([^"]*)"', "".join(svgs))
    assert len(ids) == len(set(ids))
    assert page == report_of(metrics)


def test_lines_of_a_plot_are_where_its_points_are():
    """The drawn line is an affine image of the curve's points."""
    plot = plots_of(example_metrics(example_map("ours", 0.9)))[0]
    paths = re.findall(r'<path d="([^"]*)"[^>]*clip-path[^>]*stroke: #0072b2', svg_of(plot))
    drawn = numpy.array(re.findall(r"[ML] (\S+) (\S+)", paths[0]), float)
    points = numpy.array(plot.curves[1].points)
    for axis in (0, 1):
        scale = numpy.polyfit(points[:, axis], drawn[:, axis], 1)
        numpy.testing.assert_allclose(numpy.polyval(scale, points[:, axis]), drawn[:, axis],
                                      atol=0.01)


def test_plots_of_studies_are_drawn(report_of):
    page = report_of({"study": "fig3.2", "plots": [
        {"title": "KL divergence", "x_label": "size", "y_label": "nat",
         "curves": [{"label": "", "emphasised": False, "points": [[1, 2], [3, 4]]},
                    {"label": "mean", "emphasised": True, "points": [[1, 2], [3, 4]]}]}]})
    assert page.count("<svg") == 1 and "KL divergence" in page and "<table" not in page


def ply(places, **columns):
    """A binary PLY of vertices with further float or uchar properties."""
    fields = [(axis, "<f8") for axis in "xyz"] + [(n, v.dtype.str) for n, v in columns.items()]
    vertices = numpy.zeros(len(places), fields)
    for k, axis in enumerate("xyz"):
        vertices[axis] = places[:, k]
    for name, values in columns.items():
        vertices[name] = values
    kinds = {"<f8": "double", "<f4": "float", "|u1": "uchar"}
    head = "".join(f"property {kinds[kind]} {name}\n" for name, kind in fields)
    return (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(places)}\n{head}"
            "end_header\n").encode() + vertices.tobytes()


def test_pictures_show_points_in_their_colours(tmp_path):
    from matplotlib import image
    from hgmm.report.clouds import draw_clouds
    # Seen along y: red on the left, blue above green on the right; before red stands white.
    places = numpy.array([[-1, 5, 0], [1, 5, 1], [1, 5, -1], [-1, 1, 0]])
    colour = numpy.array([[255, 0, 0], [0, 0, 255], [0, 255, 0], [255, 255, 255]], numpy.uint8)
    (tmp_path / "c.ply").write_bytes(ply(places, red=colour[:, 0], green=colour[:, 1],
                                         blue=colour[:, 2]))
    look = {"file": "c.ply", "yaw_deg": 90, "pitch_deg": 0, "edge_m": 0.5}
    whole, opened = draw_clouds(tmp_path, [look, {**look, "cut": 0.5}])
    (tmp_path / "whole.png").write_bytes(whole)
    (tmp_path / "opened.png").write_bytes(opened)
    whole = image.imread(tmp_path / "whole.png")[..., :3]
    opened = image.imread(tmp_path / "opened.png")[..., :3]
    height, width = whole.shape[:2]
    assert width > 500
    numpy.testing.assert_array_equal(whole[5, width - 5], [0, 0, 1])
    numpy.testing.assert_array_equal(whole[height - 5, width - 5], [0, 1, 0])
    numpy.testing.assert_array_equal(whole[height // 2, 5], [1, 1, 1])
    numpy.testing.assert_array_equal(opened[height // 2, 5], [1, 0, 0])


def test_the_axes_of_a_view_are_right_handed_and_look_where_they_should():
    numpy.testing.assert_allclose(view_axes(0, 0), [[0, -1, 0], [0, 0, -1], [1, 0, 0]], atol=1e-12)
    numpy.testing.assert_allclose(view_axes(0, 90)[2], [0, 0, -1], atol=1e-12)
    axes = view_axes(35, 40)
    numpy.testing.assert_allclose(numpy.cross(axes[0], axes[1]), axes[2], atol=1e-12)
    assert axes[1, 2] < 0


def test_the_map_is_shown_where_metrics_name_it(report_of, room, tmp_path):
    room.save(tmp_path / "map.hgmm")
    metrics = example_metrics(example_map("ours", 0.9))
    assert "<iframe" not in report_of(metrics)
    page = report_of({**metrics, "view": {"map": "map.hgmm"}})
    assert page.count("<iframe") == 1 and "&lt;canvas" in page and "<canvas" not in page


def run_report(*words):
    return subprocess.run([sys.executable, "-m", "hgmm.report", *map(str, words)],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_the_program_writes_beside_metrics_or_says_why_not(tmp_path):
    assert "metrics.json: No such file" in run_report(tmp_path).stderr
    (tmp_path / "metrics.json").write_text("{")
    assert "is no JSON" in run_report(tmp_path).stderr
    (tmp_path / "metrics.json").write_text("[1]")
    done = run_report(tmp_path)
    assert done.returncode == 1 and "is no metrics.json of hgmm-replay" in done.stderr
    assert not (tmp_path / "report.html").exists()
    (tmp_path / "metrics.json").write_text(json.dumps(example_metrics(example_map("m", 0.9))))
    done = run_report(tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "report.html").read_text().startswith("<!DOCTYPE html>")
