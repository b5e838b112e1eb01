"""An atlas as a graph of tasks on Dask distributed. What comes out depends on the segments and
settings alone: neither on the number of workers nor on the order in which tasks end."""
import pathlib
import uuid

from distributed import as_completed

from hgmm.atlas import plan, tasks
from hgmm.atlas.files import FORMAT, write_json

RETRIES = 2
"""how often a task that failed is tried again, elsewhere if possible"""


def make_atlas(client, segments, settings, folder, tell=lambda text: None):
    """Maps the segments, merges their shards tile by tile and writes the tiles and the index.

    segments: their order is that of the merges, so that of plan.segments_of().
    Returns the index. Raises TaskError.
    """
    shards = map_segments(client, segments, settings, folder, tell)
    folder.index.unlink(missing_ok=True)  # it would describe other tiles than there are
    entries = merge_tiles(client, shards, folder, tell)
    for entry in entries:
        tile = plan.Tile(entry["x"], entry["y"])
        entry["segments"] = [number for number, of in enumerate(shards) if tile in of]
    index = {"format": FORMAT, "version": 1, "tile_m": settings.tile_m,
             "margin_m": settings.margin_m,
             "segments": [{"log": pathlib.Path(s.log).name, "first": s.first, "last": s.last}
                          for s in segments],
             "tiles": entries}
    write_json(folder.index, index)
    remove_others(folder, entries)
    return index


def map_segments(client, segments, settings, folder, tell):
    """The shards of each segment: tile -> name."""
    of_this = key_maker()
    futures = [client.submit(tasks.map_segment, segment, settings, folder, retries=RETRIES,
                             pure=False, key=of_this("segment", number))
               for number, segment in enumerate(segments)]
    follow(client, futures, "segments", tell)
    return client.gather(futures)


def merge_tiles(client, shards, folder, tell):
    """Entries of the index, one a tile."""
    tiles = sorted({tile for of_segment in shards for tile in of_segment})
    of_this, written, merges = key_maker(), [], 0
    for tile in tiles:
        root, nodes = plan.merges_of({number: of_segment[tile]
                                      for number, of_segment in enumerate(shards)
                                      if tile in of_segment})
        futures = {}
        for node in nodes:
            inputs = [futures[name] for name in (node.left, node.right) if name in futures]
            futures[node.name] = client.submit(
                tasks.merge_shards, node, folder, *inputs, retries=RETRIES, pure=False,
                key=of_this("merge", f"{tile}-{node.name}"))
        inputs = [futures[root]] if root in futures else []
        written.append(client.submit(tasks.write_tile, tile, root, folder, *inputs,
                                     retries=RETRIES, pure=False, key=of_this("tile", tile)))
        merges += len(nodes)
    tell(f"{merges} merges for {len(tiles)} tiles")
    follow(client, written, "tiles", tell)
    return client.gather(written)


def key_maker():
    """Keys of tasks that no other call and no other client of the scheduler has. The dashboard
    groups tasks by their kind."""
    call = uuid.uuid4().hex[:12]
    return lambda kind, what: f"{kind}-{call}-{what}"


def follow(client, futures, what, tell):
    """Tells of each task that is done. The first that fails ends all others, and its error is
    raised."""
    for done, future in enumerate(as_completed(futures, loop=client.loop), 1):
        if future.status == "error":
            error = future.exception()
            client.cancel(futures)
            raise error
        tell(f"{done} of {len(futures)} {what}")


def remove_others(folder, entries):
    """Tiles of an earlier atlas in this folder that this one does not have."""
    kept = {folder.path / entry["file"] for entry in entries}
    for file in (folder.path / "tiles").glob("*.hgmm"):
        if file not in kept:
            file.unlink()
