"""Queries of an atlas: each point is asked of its tile."""
import collections
import pathlib

import numpy

import hgmm
from hgmm.atlas.files import Folder, read_json
from hgmm.atlas.plan import Tile


class Atlas:
    """Tiles of an atlas, loaded when they are asked for.

    folder: as hgmm-atlas -o made it.
    loaded_tiles: so many stay in memory, those asked for last.

    Raises OSError where there is no index, and ValueError where it is of another kind.
    """

    def __init__(self, folder, loaded_tiles=9):
        self.folder = Folder(folder)
        index = read_json(self.folder.index)
        if index.get("format") != "hgmm-atlas" or index.get("version") != 1:
            raise ValueError(f"{self.folder.index}: no index of an atlas that this version reads")
        self.index = index
        self.tile_m = index["tile_m"]
        self._files = {Tile(t["x"], t["y"]): pathlib.Path(t["file"]) for t in index["tiles"]}
        self._loaded = collections.OrderedDict()
        self._loaded_tiles = loaded_tiles

    @property
    def tiles(self):
        return sorted(self._files)

    def map_of(self, tile):
        """A tile's hgmm.Map; None where nothing was seen."""
        if tile not in self._files:
            return None
        if tile not in self._loaded:
            self._loaded[tile] = hgmm.Map.load(self.folder.path / self._files[tile])
        self._loaded.move_to_end(tile)
        while len(self._loaded) > self._loaded_tiles:
            self._loaded.popitem(last=False)
        return self._loaded[tile]

    def occupancy(self, points_map):
        """As hgmm.Map.occupancy. A point that is not finite, or of no tile, is unknown."""
        points = numpy.ascontiguousarray(points_map, dtype=float)
        answers = [numpy.zeros(len(points), numpy.float32) for _ in hgmm.Occupancy._fields]
        answers[hgmm.Occupancy._fields.index("unknown")][:] = 1
        finite = numpy.flatnonzero(numpy.isfinite(points).all(axis=1))
        corners = numpy.floor(points[finite, :2] / self.tile_m).astype(int)
        numbers, of = numpy.unique(corners, axis=0, return_inverse=True)
        for k, number in enumerate(numbers):
            tile_map = self.map_of(Tile(*number.tolist()))
            if tile_map is None:
                continue
            rows = finite[of == k]
            for answer, part in zip(answers, tile_map.occupancy(points[rows])):
                answer[rows] = part
        return hgmm.Occupancy(*answers)
