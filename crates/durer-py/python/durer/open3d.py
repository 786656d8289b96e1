"""Drop-in replacement for Open3D's `RaycastingScene`, with numpy arrays instead of tensors."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _durer
from ._arrays import as_points, rows
from .hits import Hits
from .rays import Mesh, Scene, _Rays, split_rays

_Answers = dict[str, npt.NDArray[Any]]


class RaycastingScene:
    """Ray queries on triangle meshes. Each ray is six numbers: origin and direction. Indices are
    uint32, `INVALID_ID` for misses. As in Open3D, a point is inside if an odd number of meshes
    contain it."""

    INVALID_ID = 0xFFFF_FFFF

    def __init__(self, nthreads: int = 0, device: Any = None) -> None:
        self._threads = nthreads or None
        self._meshes: list[Mesh] = []
        self._scene: Optional[_Rays] = None

    def add_triangles(self, vertex_positions: Any, triangle_indices: Optional[npt.ArrayLike] = None) -> int:
        """Adds a mesh, given as arrays or as one of Open3D's meshes, and returns its index."""
        faces: Any = triangle_indices
        if faces is None:
            vertex_positions, faces = (
                part.numpy() if hasattr(part, "numpy") else part
                for part in (vertex_positions.vertex.positions, vertex_positions.triangle.indices)
            )
        self._meshes.append(Mesh(vertex_positions, faces))
        self._scene = None
        return len(self._meshes) - 1

    def _built(self) -> _Rays:
        if self._scene is None:
            self._scene = self._meshes[0] if len(self._meshes) == 1 else Scene(self._meshes)
        return self._scene

    @staticmethod
    def _ids(numbers: npt.NDArray[Any]) -> npt.NDArray[np.uint32]:
        # The cast turns -1 into `INVALID_ID`, 2^32 - 1.
        return numbers.astype(np.int32, copy=False).view(np.uint32)

    def cast_rays(self, rays: npt.ArrayLike, nthreads: int = 0) -> _Answers:
        """Returns the first hit of each ray."""
        hits: Hits = self._built().closest(*split_rays(rays), threads=nthreads or self._threads)
        return {
            "t_hit": hits.t,
            "geometry_ids": self._ids(hits.object),
            "primitive_ids": self._ids(hits.triangle),
            "primitive_uvs": hits.uv,
            "primitive_normals": hits.normal,
        }

    def test_occlusions(
        self, rays: npt.ArrayLike, tnear: float = 0.0, tfar: float = np.inf, nthreads: int = 0
    ) -> npt.NDArray[np.bool_]:
        """Returns True for each ray that hits anything."""
        return self._built().occluded(*split_rays(rays), tnear, tfar, threads=nthreads or self._threads)

    def count_intersections(self, rays: npt.ArrayLike, nthreads: int = 0) -> npt.NDArray[np.int32]:
        """Returns the number of triangles that each ray crosses."""
        return self._built().count(*split_rays(rays), threads=nthreads or self._threads)

    def list_intersections(self, rays: npt.ArrayLike, nthreads: int = 0) -> _Answers:
        """Returns all hits of all rays."""
        hits = self._built().all_hits(*split_rays(rays), threads=nthreads or self._threads)
        return {
            "ray_splits": hits.offsets,
            "ray_ids": hits.ray,
            "t_hit": hits.t,
            "geometry_ids": self._ids(hits.object),
            "primitive_ids": self._ids(hits.triangle),
            "primitive_uvs": hits.uv,
        }

    def compute_closest_points(self, query_points: npt.ArrayLike, nthreads: int = 0) -> _Answers:
        """Returns the point on the surface nearest to each query point."""
        scene = self._built()
        near = scene.nearest(query_points, threads=nthreads or self._threads)
        met = (near.object.reshape(-1), near.triangle.reshape(-1), rows(near.uv.astype(np.float32), 2))
        normal = _durer.hit_normals(scene._tree, met, nthreads or self._threads)
        return {
            "points": near.point.astype(np.float32),
            "geometry_ids": self._ids(near.object),
            "primitive_ids": self._ids(near.triangle),
            "primitive_uvs": near.uv.astype(np.float32),
            "primitive_normals": normal.reshape(near.point.shape),
        }

    def compute_distance(self, query_points: npt.ArrayLike, nthreads: int = 0) -> npt.NDArray[np.float32]:
        """Returns the distance of each point from the surface."""
        return self._built().distance(query_points, threads=nthreads or self._threads).astype(np.float32)

    def compute_signed_distance(
        self, query_points: npt.ArrayLike, nthreads: int = 0, nsamples: int = 1
    ) -> npt.NDArray[np.float32]:
        """Returns the distance of each point from the surface, negative inside. `nsamples` is
        ignored, because one ray is exact."""
        distance = self.compute_distance(query_points, nthreads)
        return np.where(self._inside(query_points, nthreads), -distance, distance)

    def compute_occupancy(
        self, query_points: npt.ArrayLike, nthreads: int = 0, nsamples: int = 1
    ) -> npt.NDArray[np.float32]:
        """Returns 1 for points inside and 0 for points outside."""
        return self._inside(query_points, nthreads).astype(np.float32)

    def _inside(self, query_points: npt.ArrayLike, nthreads: int) -> npt.NDArray[np.bool_]:
        """Returns which points are inside, by the parity of all crossings. As in Open3D, a point
        inside two meshes counts as outside."""
        points, threads = as_points("query_points", query_points), nthreads or self._threads
        inside = np.zeros(points.shape[:-1], np.bool_)
        for mesh in self._meshes:
            inside ^= mesh.contains(points, threads=threads)
        return inside

    @staticmethod
    def create_rays_pinhole(
        intrinsic_matrix: npt.ArrayLike, extrinsic_matrix: npt.ArrayLike, width_px: int, height_px: int
    ) -> npt.NDArray[np.float32]:
        """Returns rays through the pixel centres, of shape (height, width, 6). The centre of the
        first pixel is at (0.5, 0.5)."""
        inner = np.linalg.inv(np.asarray(intrinsic_matrix, np.float64))
        outer = np.asarray(extrinsic_matrix, np.float64)
        x, y = np.meshgrid(np.arange(width_px) + 0.5, np.arange(height_px) + 0.5)
        ways = np.stack([x, y, np.ones_like(x)], -1) @ inner.T @ outer[:3, :3]
        eye = -outer[:3, :3].T @ outer[:3, 3]
        return np.concatenate([np.broadcast_to(eye, ways.shape), ways], -1).astype(np.float32)
