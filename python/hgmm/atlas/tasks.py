"""What workers do. Each task reads and writes files and returns a few words; one whose result
is there already returns at once, so that a task may be done again after a worker ended."""
import hashlib
import pathlib
import shutil
import subprocess
import tempfile

import numpy

import hgmm
from hgmm.atlas.files import read_json, write_json
from hgmm.atlas.plan import Tile, segment_name, shard_name, tile_at


class TaskError(RuntimeError):
    """An input that cannot be mapped; its text is for the user."""


def replay(*words):
    """Runs hgmm-replay and returns what it prints. Raises TaskError with its complaint."""
    program = shutil.which("hgmm-replay")
    if program is None:
        raise TaskError("hgmm-replay is not in the PATH of a worker")
    done = subprocess.run([program, *map(str, words)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise TaskError(done.stderr.strip() or f"hgmm-replay ended with {done.returncode}")
    return done.stdout


def count_scans(log):
    return int(replay(log, "--count"))


def map_segment(segment, settings, folder):
    """Maps a segment and cuts its map into shards, one a tile with its margin.

    Returns the segment's shards: tile -> name.
    """
    name = segment_name(segment, settings)
    done = folder.segment(name)
    if not done.exists():
        with tempfile.TemporaryDirectory(dir=folder.work) as place:
            made = map_of(segment, settings, pathlib.Path(place) / "map.hgmm")
        tiles = tiles_of(made, settings.tile_m)
        for tile in tiles:
            part = made.crop(*tile.box(settings.tile_m, settings.margin_m))
            part.save(folder.shard(shard_name(name, tile)), exact=True)
        write_json(done, [[tile.x, tile.y] for tile in tiles])
    return {tile: shard_name(name, tile) for tile in (Tile(*t) for t in read_json(done))}


def map_of(segment, settings, file):
    options = ["--config", settings.config] if settings.config else []
    if settings.split:
        options += ["--split", settings.split]
    replay(segment.log, "--poses", segment.poses, "--from", segment.first, "--to", segment.last,
           "--threads", 1, "--quiet", "--save-map", file, *options)
    return hgmm.Map.load(file)


def tiles_of(made, tile_m):
    """The tiles in which a map knows anything, in a fixed order: those of its components, and
    from there all neighbours that rays passed."""
    means = numpy.concatenate([made.mixture().mean[:, :2], made.free_mixture().mean[:, :2]])
    of_means = {tile_at(mean, tile_m) for mean in means}
    found, seen, waiting = set(), set(of_means), set(of_means)
    while waiting:
        tile = waiting.pop()
        if tile not in of_means and not has_rays(made, tile.box(tile_m)):
            continue
        found.add(tile)
        new = set(tile.neighbours()) - seen
        seen |= new
        waiting |= new
    return sorted(found)


def has_rays(made, box):
    """Whether rays passed a box. A crop also knows of rays behind its surfaces, outside."""
    everything = numpy.full(3, -1e9), numpy.full(3, 1e9)
    part = made.crop(*box)
    part.forget(*everything)
    return part.crop(*box).coverage_bytes > 0


def merge_shards(node, folder, *_inputs):
    """Makes one shard of two. `_inputs` are results of the tasks that make these."""
    file = folder.shard(node.name)
    if not file.exists():
        merged = hgmm.Map.load(folder.shard(node.left))
        merged.merge(hgmm.Map.load(folder.shard(node.right)))
        merged.save(file, exact=True)
    return node.name


def write_tile(tile, root, folder, *_inputs):
    """Writes a tile's file and returns its entry in the index."""
    made = hgmm.Map.load(folder.shard(root))
    file = folder.tile(tile)
    made.save(file)
    content = file.read_bytes()
    return {"x": tile.x, "y": tile.y, "file": str(file.relative_to(folder.path)),
            "bytes": len(content), "sha256": hashlib.sha256(content).hexdigest(),
            "surfaces": len(made.mixture().support)}
