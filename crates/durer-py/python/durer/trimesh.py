"""Drop-in replacement for the ray queries of `trimesh`.

    mesh.ray = durer.trimesh.RayMeshIntersector(mesh)

Names, arguments and results are those of `trimesh.ray.ray_pyembree.RayMeshIntersector`.
Differences: no ray is lost at edges and vertices, no hit is skipped or found twice because of an
offset, and `contains_points` is exact.
"""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._arrays import Floats
from .rays import Mesh

_Ints = npt.NDArray[np.int64]
_Doubles = npt.NDArray[np.float64]


class RayMeshIntersector:
    """Ray queries on a `trimesh.Trimesh`. The first query builds the tree, and the first query
    after a change of the mesh rebuilds it.

    The mesh is traced relative to the centre of its bounds, so no precision is lost far from the
    origin. `scale_to_box` is ignored.
    """

    def __init__(self, geometry: Any, scale_to_box: bool = True) -> None:
        self.mesh = geometry
        self._scale_to_box = scale_to_box
        self._known: Optional[tuple[int, Mesh, _Doubles]] = None

    def _tree(self) -> tuple[Mesh, _Doubles]:
        now = hash(self.mesh)
        if self._known is None or self._known[0] != now:
            vertices = np.asarray(self.mesh.vertices, np.float64)
            middle: _Doubles = (vertices.min(0) + vertices.max(0)) / 2 if len(vertices) else np.zeros(3)
            self._known = (now, Mesh(vertices - middle, np.asarray(self.mesh.faces)), middle)
        return self._known[1:]

    def _rays(self, origins: npt.ArrayLike, directions: npt.ArrayLike) -> tuple[Mesh, Floats, Floats]:
        tree, middle = self._tree()
        starts, ways = np.asarray(origins, np.float64), np.asarray(directions, np.float64)
        if starts.shape != ways.shape:
            raise ValueError(f"ray origins and directions must have one shape, but have {starts.shape} and {ways.shape}")
        square = np.einsum("...i,...i->...", ways, ways)
        # Rescale directions that would underflow or overflow in single precision.
        if bool(((square < 1e-30) | (square > 1e30)).any()):
            largest = np.abs(ways).max(-1, keepdims=True)
            ways = np.divide(ways, largest, out=np.zeros_like(ways), where=largest > 0)
        return tree, (starts - middle).astype(np.float32), ways.astype(np.float32)

    def intersects_location(
        self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike, multiple_hits: bool = True
    ) -> tuple[_Doubles, _Ints, _Ints]:
        """Returns the hit points, and the indices of the ray and the triangle of each."""
        triangle, ray, places = self.intersects_id(ray_origins, ray_directions, multiple_hits, return_locations=True)
        return places, ray, triangle

    def intersects_id(
        self,
        ray_origins: npt.ArrayLike,
        ray_directions: npt.ArrayLike,
        multiple_hits: bool = True,
        max_hits: int = 100,
        return_locations: bool = False,
    ) -> Any:
        """Returns the indices of the triangle and the ray of each hit, and optionally the points.
        Only first hits are returned, or at most `max_hits` per ray."""
        tree, origins, ways = self._rays(ray_origins, ray_directions)
        if multiple_hits:
            hits = tree.all_hits(origins, ways)
            number = np.arange(len(hits)) - np.repeat(hits.offsets[:-1], hits.count.reshape(-1))
            kept = number < max_hits
            ray, triangle, uv = hits.ray[kept], hits.triangle[kept], hits.uv[kept]
        else:
            first = tree.closest(origins, ways)
            ray = np.flatnonzero(first.hit)
            triangle, uv = first.triangle[ray], first.uv[ray]
        triangle = triangle.astype(np.int64)
        if not return_locations:
            return triangle, ray
        a, b, c = (np.asarray(self.mesh.vertices, np.float64)[np.asarray(self.mesh.faces)[triangle, i]] for i in range(3))
        u, v = uv[:, :1].astype(np.float64), uv[:, 1:].astype(np.float64)
        return triangle, ray, (1 - u - v) * a + u * b + v * c

    def intersects_first(self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike) -> _Ints:
        """Returns the index of the first triangle that each ray hits, or -1."""
        tree, origins, ways = self._rays(ray_origins, ray_directions)
        return tree.closest(origins, ways).triangle.astype(np.int64)

    def intersects_any(self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Returns True for each ray that hits anything."""
        tree, origins, ways = self._rays(ray_origins, ray_directions)
        return tree.occluded(origins, ways)

    def contains_points(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Returns True for each point that is inside the mesh."""
        tree, middle = self._tree()
        return tree.contains(np.asarray(points, np.float64) - middle)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_known": None}

    def __copy__(self, *_: Any) -> RayMeshIntersector:
        return RayMeshIntersector(self.mesh, self._scale_to_box)

    __deepcopy__ = __copy__
