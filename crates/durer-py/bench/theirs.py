"""Runs other packages' own ray tests against Dürer's classes.

    python crates/durer-py/bench/theirs.py embreex test_intersection.py
    python crates/durer-py/bench/theirs.py open3d test_raycasting_scene.py

The test files come from the packages' repositories: `tests/test_intersection.py` of
trimesh/embreex, and `python/test/t/geometry/test_raycasting_scene.py` of isl-org/Open3D, which
needs open3d itself for its tensors and meshes. They run unchanged, except that the names they
import refer to Dürer's classes.
"""

import sys
import types
from typing import Any

import numpy as np
import pytest

import durer.embreex
import durer.open3d


def embreex() -> None:
    """Installs modules with the names of embreex's, which contain Dürer's classes."""
    for name in ("embreex", "embreex.rtcore", "embreex.rtcore_scene", "embreex.mesh_construction"):
        sys.modules[name] = module = types.ModuleType(name)
        module.__dict__.update(vars(durer.embreex))
    for name in ("rtcore", "rtcore_scene", "mesh_construction"):
        setattr(sys.modules["embreex"], name, sys.modules[f"embreex.{name}"])


def open3d() -> None:
    """Replaces Open3D's class with Dürer's. Converts tensors to arrays, and results back to
    tensors."""
    import open3d as o3d

    def array(value: Any) -> Any:
        return value.cpu().numpy() if isinstance(value, o3d.core.Tensor) else value

    def tensor(value: Any) -> Any:
        if isinstance(value, dict):
            return {name: tensor(part) for name, part in value.items()}
        return o3d.core.Tensor.from_numpy(np.ascontiguousarray(value)) if isinstance(value, np.ndarray) else value

    class RaycastingScene(durer.open3d.RaycastingScene):
        def __getattribute__(self, name: str) -> Any:
            found = super().__getattribute__(name)
            if name.startswith("_") or not callable(found):
                return found
            return lambda *args, **named: tensor(found(*map(array, args), **{key: array(value) for key, value in named.items()}))

    o3d.t.geometry.RaycastingScene = RaycastingScene
    # Replacement for a helper of their tests: the list of devices to try.
    sys.modules["open3d_test"] = helper = types.ModuleType("open3d_test")
    helper.list_devices = lambda **_: [o3d.core.Device("CPU:0")]  # type: ignore[attr-defined]


if __name__ == "__main__":
    {"embreex": embreex, "open3d": open3d}[sys.argv[1]]()
    sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", *sys.argv[2:]]))
