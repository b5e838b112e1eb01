"""A map as a page to look at: one HTML file that needs neither network nor server.

python3 -m hgmm.view MAP.hgmm -o page.html
"""
from hgmm.view.page import make_page
from hgmm.view.scene import Scene, scene_of

__all__ = ["Scene", "make_page", "scene_of"]
