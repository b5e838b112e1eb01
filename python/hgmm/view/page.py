"""One HTML file with everything in it: three.js, the scene, the program."""
import base64
import html
import importlib.resources
import json
import pathlib
import re
import zlib

import numpy

THREE_FOLDER = pathlib.Path("/usr/share/javascript/three")
"""Debian's package libjs-three"""
THREE_FILES = ("three.min.js", "examples/js/controls/OrbitControls.js")
PROGRAM = ("data.js", "colours.js", "shaders.js", "ellipsoids.js", "slice.js", "layers.js",
           "trajectory.js", "picking.js", "scene.js", "panel.js", "main.js")


def three_js():
    """The library, as Debian installs it. Raises ImportError where it is not installed."""
    try:
        return "\n".join((THREE_FOLDER / name).read_text(encoding="utf-8")
                         for name in THREE_FILES)
    except OSError:
        raise ImportError(f"{THREE_FOLDER / THREE_FILES[0]} is missing: install libjs-three, "
                          "which draws the page") from None


def web(name):
    return (importlib.resources.files("hgmm.view") / "web" / name).read_text(encoding="utf-8")


class Archive:
    """Arrays one after the other, and a table of where each is."""

    def __init__(self):
        self.table, self.parts, self.size = {}, [], 0

    def add(self, name, array):
        array = numpy.ascontiguousarray(array)
        content = array.astype(array.dtype.newbyteorder("<")).tobytes()
        content += bytes(-len(content) % 4)
        self.table[name] = {"type": array.dtype.name, "at": self.size, "count": array.size}
        self.parts.append(content)
        self.size += len(content)

    def text(self):
        return base64.b64encode(zlib.compress(b"".join(self.parts), 6)).decode()


def add_ellipsoids(archive, name, ellipsoids):
    for field in ("mean", "deviation", "turn", "support"):
        archive.add(f"{name}.{field}", getattr(ellipsoids, field))


def described(scene, up):
    """The scene as a table of facts, which JSON can hold, and an archive of its arrays."""
    archive = Archive()
    add_ellipsoids(archive, "surfaces", scene.surfaces)
    add_ellipsoids(archive, "free", scene.free)
    archive.add("occupied", scene.occupied)
    archive.add("deviation", scene.along_ray_deviation)
    for name, values in scene.modalities.items():
        archive.add(f"modality.{name}", values)
    archive.add("lattice", scene.lattice.answers)
    if scene.points is not None:
        archive.add("points", scene.points)
    if scene.poses is not None:
        archive.add("poses.time", scene.poses.time - scene.poses.time[0])
        archive.add("poses.position", scene.poses.position.astype(numpy.float32))
        archive.add("poses.turn", scene.poses.turn.astype(numpy.float32))
    facts = {
        "up": up,
        "centre": scene.centre.tolist(),
        "half": ((scene.high - scene.low) / 2).tolist(),
        "finest": scene.finest,
        "surfaces": scene.surfaces.first,
        "free": scene.free.first,
        "modalities": list(scene.modalities),
        "lattice": {"low": scene.lattice.low.tolist(), "cell": scene.lattice.cell.tolist(),
                    "counts": scene.lattice.answers.shape[2::-1]},
        "hasPoints": scene.points is not None,
        "poses": 0 if scene.poses is None else len(scene.poses.time),
        "arrays": archive.table,
    }
    return facts, archive.text()


def make_page(scene, title, up="z"):
    """The page as text.

    up: the axis of the map that points up: z, -y, ...

    Raises ImportError where three.js is not installed.
    """
    library = three_js()
    facts, arrays = described(scene, up)
    parts = {
        "TITLE": html.escape(title),
        "STYLE": web("view.css"),
        "LIBRARY": library,
        "FACTS": json.dumps(facts).replace("<", "\\u003c"),
        "ARRAYS": arrays,
        "PROGRAM": "(() => {\n'use strict';\n" + "\n".join(web(n) for n in PROGRAM) + "})();\n",
    }
    return re.sub(r"\{\{([A-Z]+)\}\}", lambda found: parts[found.group(1)], web("page.html"))
