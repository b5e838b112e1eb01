"""The report as one HTML file."""
import html
import importlib.resources
import json

from hgmm import Map
from hgmm.report.clouds import draw_clouds
from hgmm.report.drawing import image, svg_of
from hgmm.report.plots import plots_of
from hgmm.report.tables import ACCURACY, COST, table
from hgmm.view.inputs import read_points, read_poses
from hgmm.view.page import make_page
from hgmm.view.scene import scene_of


def read_metrics(folder):
    """What a run measured. Raises OSError, or ValueError for a file that is no metrics.json."""
    file = folder / "metrics.json"
    try:
        metrics = json.loads(file.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ValueError(f"{file}: is no JSON: {error}") from None
    if not isinstance(metrics, dict) or not {"dataset", "study"} & set(metrics):
        raise ValueError(f"{file}: is no metrics.json of hgmm-replay")
    return metrics


def split_text(protocol):
    parts = []
    if protocol["split"] > 0:
        parts.append(f"one scan of {protocol['split']} tests the maps")
    if protocol["holdout_points"] > 0:
        parts.append(f"{100 * protocol['holdout_points']:g} % of the points of mapping scans are "
                     "held out")
    return "; ".join(parts) or "all scans build the maps, none tests them"


def facts_of(metrics):
    data, protocol = metrics["dataset"], metrics["protocol"]
    yield "Sensor", data["sensor"]
    yield "Scans", (f"{data['scans_mapped']} mapped, {data['scans_tested']} tested, "
                    f"{data['points_per_scan']:.0f} points each")
    yield "Split", split_text(protocol)
    if protocol["subsample"] < 1:
        yield "Points used", f"{100 * protocol['subsample']:g} % of each mapping scan"
    if protocol["range_noise_m"] > 0:
        yield "Noise added to ranges", f"{protocol['range_noise_m']:g} m, one sigma"
    yield "Hits asked for", f"up to {protocol['queries_per_scan']} of each scan with test points"
    near, free = protocol["near_m"], protocol["free_band_m"]
    yield "Near free points", f"{near[0]:g} to {near[1]:g} m before the hit"
    yield "Uniform free points", (f"{free[0]:g} m after the sensor to {free[1]:g} m before the "
                                  "hit")
    yield "Seed", str(protocol["seed"])
    yield "Threads", f"{protocol['threads']} for the first map, 1 for others"


def heading(metrics, title):
    text = f"<header>\n<h1>{html.escape(title)}</h1>\n"
    if "dataset" not in metrics:
        return text + "</header>\n"
    text += ('<p class="note">Occupancy maps built from the same scans and asked about the same '
             "points, by hgmm-replay.</p>\n")
    if metrics["dataset"].get("interrupted"):
        text += ('<p class="warning">The run was interrupted: everything here is of the scans '
                 "until then.</p>\n")
    facts = "".join(f"<div><dt>{name}</dt><dd>{html.escape(value)}</dd></div>\n"
                    for name, value in facts_of(metrics))
    return text + f'<dl class="facts">\n{facts}</dl>\n</header>\n'


def tables(maps):
    if not maps:
        return ""
    text = "<section>\n<h2>Maps</h2>\n"
    if any("auc_uniform" in m for m in maps):
        text += table("Accuracy of occupancy at points that no map saw", maps, ACCURACY)
        text += ('<p class="note">\u2191 higher is better, \u2193 lower is better, best in bold. '
                 "AUC: chance that a hit scores higher than a free point. TPR: share of hits "
                 "found while 5 % of near free points are mistaken for occupied. Brier score and "
                 "expected calibration error (ECE) judge the probabilities themselves.</p>\n")
    else:
        text += "<p>There were no test points, so accuracy was not measured.</p>\n"
    return text + table("Cost", maps, COST) + (
        '<p class="note">Saved: before compression. Live: heap held, by the map\u2019s own '
        "account. First and last tenth: medians, whose difference is the trend.</p>\n</section>\n")


def view_of(folder, files, poses, title, say):
    """The map to look at, as a page within the page.

    files: names of the map and the points in the folder, by those words.
    """
    if "map" not in files:
        return ""
    map_ = Map.load(folder / files["map"])
    if map_.empty:
        return ""
    points = read_points(folder / files["points"]) if "points" in files else None
    try:
        path = read_poses(poses) if poses else None
    except ValueError as error:
        say(f"the view is without the path: {error}")
        path = None
    try:
        page = make_page(scene_of(map_, path, points, say), title)
    except ImportError as error:
        say(f"the report is without a view of the map: {error}")
        return ""
    return ('<section>\n<h2>The map</h2>\n<iframe class="view" loading="lazy" '
            f'title="The map in 3D" srcdoc="{html.escape(page)}"></iframe>\n</section>\n')


def pictures(folder, listed):
    if not listed:
        return ""
    text = '<section>\n<h2>Pictures</h2>\n<div class="grid">\n'
    for picture, png in zip(listed, draw_clouds(folder, listed)):
        title = html.escape(picture["title"])
        text += (f"<figure>\n<h3>{title}</h3>\n{image(png, title)}\n"
                 f"<figcaption>{html.escape(picture['caption'])}</figcaption>\n</figure>\n")
    return text + "</div>\n</section>\n"


def plots(metrics):
    drawn = "".join(
        f"<figure>\n{svg_of(plot)}\n<figcaption>{html.escape(plot.caption)}</figcaption>\n"
        "</figure>\n" for plot in plots_of(metrics))
    if not drawn:
        return ""
    return f'<section>\n<h2>Plots</h2>\n<div class="grid">\n{drawn}</div>\n</section>\n'


def more_figures(map_):
    """What only some maps can be asked for."""
    text = ""
    if "components_surface" in map_:
        text += (f"{map_['components_surface']} components of surfaces, "
                 f"{map_['components_free']} of free space. ")
    if map_.get("loglik_hit") is not None:
        text += f"Held-out log-likelihood {map_['loglik_hit']:.3f} nat/point. "
    if map_.get("f1_5cm") is not None:
        text += (f"Reconstruction: F1 at 5 cm {map_['f1_5cm']:.4f}, Chamfer distance "
                 f"{100 * map_['chamfer_m']:.2f} cm.")
    return f"<p>{text}</p>\n" if text else ""


def origins(maps):
    if not maps:
        return ""
    text = "<section>\n<h2>Where the maps come from</h2>\n"
    for map_ in maps:
        name, class_name, source = (html.escape(map_[k]) for k in ("name", "class", "source"))
        text += (f'<div class="map">\n<h3>{name}</h3>\n<p><code>{class_name}</code></p>\n'
                 f"<p>{source}</p>\n{more_figures(map_)}")
        options = "".join(f"<span>{html.escape(k)} = {v:.6g}</span> "
                          for k, v in map_.get("options", {}).items())
        text += f'<p class="options">{options}</p>\n</div>\n' if options else "</div>\n"
    return text + "</section>\n"


def make_report(folder, poses=None, say=lambda text: None):
    """The report of the metrics.json in a folder, as text. It shows the map and the points
    beside it, too, where metrics.json names them.

    poses: a file of TUM lines, or None. say: is told in one sentence what the page lacks.

    Raises OSError and ValueError for files that cannot be used.
    """
    metrics = read_metrics(folder)
    try:
        return page_of(folder, metrics, poses, say)
    except (KeyError, TypeError) as error:
        raise ValueError(f"{folder}/metrics.json: lacks {error}") from None


def page_of(folder, metrics, poses, say):
    title = metrics["dataset"]["name"] if "dataset" in metrics else metrics["study"]
    maps = metrics.get("maps", [])
    style = (importlib.resources.files("hgmm.report") / "report.css").read_text(encoding="utf-8")
    return ('<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f"<title>{html.escape(title)}: report</title>\n"
            f'<link rel="icon" href="data:,">\n<style>\n{style}</style>\n</head>\n<body>\n'
            + heading(metrics, title) + tables(maps)
            + view_of(folder, metrics.get("view", {}), poses, title, say)
            + pictures(folder, metrics.get("pictures", [])) + plots(metrics) + origins(maps)
            + "</body>\n</html>\n")
