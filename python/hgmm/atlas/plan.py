"""What is to be done: which segments there are, and in which order what they saw is merged.

Names of work files are made of all that their content depends on. A file that is there is
therefore right, whoever made it and when.
"""
import hashlib
import json
import math
import pathlib
from dataclasses import astuple, dataclass
from typing import Optional

import hgmm

TALL_M = 1e5
"""half the height of a tile [m]: tiles are columns"""


@dataclass(frozen=True)
class Settings:
    """What the maps depend on, besides the recordings."""

    tile_m: float = 100.0
    """edge of a tile [m], > 0"""
    margin_m: float = 5.0
    """a tile's file holds its surroundings so far, for distances up to there [m], >= 0"""
    config: Optional[str] = None
    """an MRPT configuration for hgmm-replay"""
    split: int = 0
    """as hgmm-replay has it: scans that are kept out of the map for tests; 0: none"""


@dataclass(frozen=True)
class Segment:
    """Successive scans of one log, mapped by one task."""

    log: str
    poses: str
    first: int
    last: int


@dataclass(frozen=True, order=True)
class Tile:
    """A column of space: its corner is tile_m times its numbers."""

    x: int
    y: int

    def box(self, tile_m, margin_m=0.0):
        """Corners in the map frame [m]."""
        low = [self.x * tile_m - margin_m, self.y * tile_m - margin_m, -TALL_M]
        high = [(self.x + 1) * tile_m + margin_m, (self.y + 1) * tile_m + margin_m, TALL_M]
        return low, high

    def neighbours(self):
        return [Tile(self.x + dx, self.y + dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)
                if dx or dy]

    def __str__(self):
        return f"{self.x}_{self.y}"


def tile_at(point_map, tile_m):
    """The tile that holds a point."""
    return Tile(math.floor(point_map[0] / tile_m), math.floor(point_map[1] / tile_m))


def segments_of(logs, poses, scans, length):
    """Segments of at most `length` scans, equally long within a log, whatever order the logs
    are named in.

    scans: how many each log holds.
    """
    segments = []
    for log, log_poses, count in sorted(zip(logs, poses, scans)):
        parts = math.ceil(count / length)
        bounds = [part * count // parts for part in range(parts + 1)]
        segments += [Segment(log, log_poses, first, end - 1)
                     for first, end in zip(bounds, bounds[1:])]
    return segments


def name_of(*parts):
    """A short name for what is made of `parts`."""
    text = json.dumps([hgmm.__version__, *parts])
    return hashlib.sha256(text.encode()).hexdigest()[:24]


def segment_name(segment, settings):
    """Changes with the recording, its poses, the configuration and all settings."""
    files = [state_of(file) for file in (segment.log, segment.poses, settings.config) if file]
    return name_of("segment", files, astuple(segment), astuple(settings))


def shard_name(segment, tile):
    """Of a segment's part in a tile; segment: its name."""
    return name_of("shard", segment, str(tile))


def state_of(file):
    """Tells a file from the same file when it was another one, without reading it."""
    stat = pathlib.Path(file).stat()
    return [str(file), stat.st_size, stat.st_mtime_ns]


@dataclass(frozen=True)
class Node:
    """Two work files that become one."""

    name: str
    left: str
    right: str


def merges_of(leaves):
    """The tree that merges a tile's shards, as the nodes in an order in which they can be made,
    and the name of its root.

    leaves: segment number -> name of its shard. The tree is one over all segment numbers, in
    which a branch without shards counts for nothing: it depends neither on when shards are
    made nor on segments that come later.
    """
    nodes = []

    def merged(first, size):
        if size == 1:
            return leaves.get(first)
        left, right = merged(first, size // 2), merged(first + size // 2, size // 2)
        if left is None or right is None:
            return left or right
        nodes.append(Node(name_of("merge", left, right), left, right))
        return nodes[-1].name

    size = 1
    while size <= max(leaves):
        size *= 2
    return merged(0, size), nodes
