"""Dürer for Python: watertight ray queries, and reproducible images whose pixels can be explained.

    import durer

    mesh = durer.Mesh(vertices, faces)
    hits = mesh.closest(origins, directions)

    pictures = durer.load("scene.txt").render(size=(640, 480))
    pictures["color"]
"""

import importlib
from typing import Any

from . import words
from ._durer import RenderError, __version__
from ._errors import SceneError
from .hits import RECORD, AllHits, Hits, Nearest
from .pictures import compare, read, write
from .rays import Mesh, Scene
from .things import Difference, Group, Intersection, Merge, Model, Moved, Object, Thing, Union_ as Union, Xor
from .words import *
from .world import Illuminance, Part, Pictures, Surfaces, World, check, kinds, load, options

__all__ = [
    "RECORD", "AllHits", "Difference", "Group", "Hits", "Illuminance", "Intersection", "Merge", "Mesh", "Model", "Moved", "Nearest", "Object",
    "Part", "Pictures", "RenderError", "Scene", "SceneError", "Surfaces", "Thing", "Union", "World", "Xor", "__version__", "check", "compare",
    "kinds", "load", "options", "read", "write", *words.__all__,
]  # fmt: skip

#: Modules that are imported on first access, because they are rarely used or need other packages.
_LAZY_MODULES = ("embreex", "farm", "open3d", "trimesh", "vision", "widget")


def __getattr__(name: str) -> Any:
    if name in _LAZY_MODULES:
        try:
            return importlib.import_module(f".{name}", __name__)
        except ModuleNotFoundError as error:
            # `help` and `hasattr` expect an AttributeError if an optional package is missing.
            raise AttributeError(str(error)) from error
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *_LAZY_MODULES])
