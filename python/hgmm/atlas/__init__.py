"""Many recordings in one map of tiles, made by many processes: docs/atlas.md.

    python3 -m hgmm.atlas LOG... --poses FILE... -o FOLDER      makes an atlas
    hgmm.atlas.Atlas(FOLDER).occupancy(points_map)              asks it
"""
from hgmm.atlas.reading import Atlas

__all__ = ["Atlas"]
