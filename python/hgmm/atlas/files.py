"""Where an atlas keeps its files, and how they are written: completely or not at all."""
import json
import pathlib

from hgmm.output import write_whole

FORMAT = "hgmm-atlas"


class Folder:
    """An atlas on disk. All workers see it under the same path.

    index.json, tiles/: the result. work/: what a later run need not do again.
    """

    def __init__(self, path):
        self.path = pathlib.Path(path).absolute()

    @property
    def index(self):
        return self.path / "index.json"

    @property
    def work(self):
        return self.path / "work"

    def tile(self, tile):
        return self.path / "tiles" / f"{tile}.hgmm"

    def segment(self, name):
        """Says which shards a segment has; written when they are."""
        return self.work / f"{name}.json"

    def shard(self, name):
        """A part of a map, of one segment or merged of several."""
        return self.work / f"{name}.hgmm"

    def prepare(self):
        """Raises ValueError for a folder that is something else."""
        if self.path.exists() and not self.path.is_dir():
            raise ValueError(f"{self.path}: is a file; an atlas is a folder")
        if (self.path.is_dir() and any(self.path.iterdir())
                and not self.index.exists() and not self.work.is_dir()):
            raise ValueError(f"{self.path}: holds other files than an atlas; name a new folder")
        if self.index.exists() and read_format(self.index) != FORMAT:
            raise ValueError(f"{self.index}: is no index of an atlas; name a new folder")
        self.work.mkdir(parents=True, exist_ok=True)
        (self.path / "tiles").mkdir(exist_ok=True)


def read_format(file):
    try:
        return read_json(file).get("format")
    except (ValueError, AttributeError):
        return None


def write_json(file, content):
    write_whole(file, json.dumps(content, indent=1) + "\n")


def read_json(file):
    return json.loads(pathlib.Path(file).read_text())
