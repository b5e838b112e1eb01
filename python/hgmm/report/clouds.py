"""Pictures of points, as studies leave them in PLY files beside metrics.json."""
import numpy

from hgmm.report.drawing import picture_figure, png_of, usual_range, view_axes
from hgmm.view.inputs import read_ply


def box_in_view(seen):
    """As far as all points but a few reach, and a third of that further, but no further than
    all: lowest and highest corner (right, down, away)."""
    low, high = numpy.quantile(seen, [0.05, 0.95], axis=0)
    margin = (high - low) / 3
    return numpy.maximum(low - margin, seen.min(axis=0)), numpy.minimum(high + margin,
                                                                      seen.max(axis=0))


def colours_of(vertices, scale):
    """As the file has them, else a value or the height for a scale of colours.

    scale: values of its first and last colour, or None.
    """
    names = vertices.dtype.names
    if "red" in names:
        return {"c": numpy.stack([vertices[c] for c in ("red", "green", "blue")], axis=1) / 255}
    values = vertices["value"] if "value" in names else vertices["z"]
    low, high = scale or usual_range(values)
    return {"c": values, "cmap": "viridis", "vmin": low, "vmax": high}


def draw_cloud(vertices, picture, box):
    """A PNG of points, or of cubes with an edge.

    picture: an entry of `pictures` in metrics.json. box: as box_in_view() has it.
    """
    axes_of_view = view_axes(picture["yaw_deg"], picture["pitch_deg"])
    places = numpy.stack([vertices[a].astype(float) for a in "xyz"], axis=1)
    seen = places @ axes_of_view.T
    low, high = box
    nearest = low[2] + picture.get("cut", 0) * (high[2] - low[2])
    kept = numpy.flatnonzero(seen[:, 2] >= nearest)
    order = kept[numpy.argsort(-seen[kept, 2], kind="stable")]
    figure, axes = picture_figure(low[:2], high[:2])
    points_per_metre = 72 * figure.get_figwidth() / (high[0] - low[0])
    edge = max(1.3, picture.get("edge_m", 0) * points_per_metre)
    look = colours_of(vertices, picture.get("scale"))
    look["c"] = look["c"][order]
    axes.scatter(seen[order, 0], seen[order, 1], s=edge ** 2, linewidths=0,
                 marker="s" if "edge_m" in picture else "o", **look)
    return png_of(figure)


def draw_clouds(folder, pictures):
    """A PNG for each entry of `pictures`. Those with the same view show the same box: that of
    the first of them."""
    boxes, drawn = {}, []
    for picture in pictures:
        file = folder / picture["file"]
        vertices = read_ply(file, file.read_bytes())
        view = picture["yaw_deg"], picture["pitch_deg"]
        if view not in boxes:
            if len(vertices) == 0:
                raise ValueError(f"{file}: holds no points")
            places = numpy.stack([vertices[a].astype(float) for a in "xyz"], axis=1)
            boxes[view] = box_in_view(places @ view_axes(*view).T)
        drawn.append(draw_cloud(vertices, picture, boxes[view]))
    return drawn
