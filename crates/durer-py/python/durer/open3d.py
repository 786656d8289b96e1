"""The calls of Open3D's `RaycastingScene`, answered by Dürer with numpy arrays in the place of tensors."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from .rays import Hits, Mesh, Scene, rays_of

_Answers = dict[str, npt.NDArray[Any]]


class RaycastingScene:
    """Triangles with rays of six numbers: origin and direction. Numbers of things are uint32, `INVALID_ID` where there is none."""

    INVALID_ID = 0xFFFF_FFFF

    def __init__(self, nthreads: int = 0, device: Any = None) -> None:
        self._threads = nthreads or None
        self._meshes: list[Mesh] = []
        self._scene: Optional[Scene] = None

    def add_triangles(self, vertex_positions: Any, triangle_indices: Optional[npt.ArrayLike] = None) -> int:
        """Adds a mesh, which may be one of Open3D's own, and gives its number."""
        faces: Any = triangle_indices
        if faces is None:
            vertex_positions, faces = (
                part.numpy() if hasattr(part, "numpy") else part
                for part in (vertex_positions.vertex.positions, vertex_positions.triangle.indices)
            )
        self._meshes.append(Mesh(vertex_positions, faces))
        self._scene = None
        return len(self._meshes) - 1

    def _asked(self) -> Scene:
        if self._scene is None:
            self._scene = Scene(self._meshes)
        return self._scene

    @staticmethod
    def _ids(numbers: npt.NDArray[Any]) -> npt.NDArray[np.uint32]:
        return np.where(numbers < 0, 0xFFFF_FFFF, numbers).astype(np.uint32)

    def cast_rays(self, rays: npt.ArrayLike, nthreads: int = 0) -> _Answers:
        """The first hit of each ray."""
        hits: Hits = self._asked().closest(*rays_of(rays), threads=nthreads or self._threads)
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
        """Whether rays meet anything."""
        return self._asked().occluded(*rays_of(rays), tnear, tfar, threads=nthreads or self._threads)

    def count_intersections(self, rays: npt.ArrayLike, nthreads: int = 0) -> npt.NDArray[np.int32]:
        """How many triangles rays cross."""
        return self._asked().count(*rays_of(rays), threads=nthreads or self._threads)

    def list_intersections(self, rays: npt.ArrayLike, nthreads: int = 0) -> _Answers:
        """All hits of all rays."""
        hits = self._asked().all_hits(*rays_of(rays), threads=nthreads or self._threads)
        return {
            "ray_splits": hits.offsets,
            "ray_ids": hits.ray,
            "t_hit": hits.t,
            "geometry_ids": self._ids(hits.object),
            "primitive_ids": self._ids(hits.triangle),
            "primitive_uvs": hits.uv,
        }

    def compute_closest_points(self, query_points: npt.ArrayLike, nthreads: int = 0) -> _Answers:
        """The nearest points of the surface."""
        scene = self._asked()
        near = scene.nearest(query_points, threads=nthreads or self._threads)
        corners = scene._corners(near.object, near.triangle)
        normal = np.cross(corners[..., 1, :] - corners[..., 0, :], corners[..., 2, :] - corners[..., 0, :])
        length = np.linalg.norm(normal, axis=-1, keepdims=True)
        return {
            "points": near.point.astype(np.float32),
            "geometry_ids": self._ids(near.object),
            "primitive_ids": self._ids(near.triangle),
            "primitive_uvs": near.uv.astype(np.float32),
            "primitive_normals": np.divide(normal, length, out=np.zeros_like(normal), where=length > 0).astype(np.float32),
        }

    def compute_distance(self, query_points: npt.ArrayLike, nthreads: int = 0) -> npt.NDArray[np.float32]:
        """How far points are from the surface."""
        return self._asked().distance(query_points, threads=nthreads or self._threads).astype(np.float32)

    def compute_signed_distance(
        self, query_points: npt.ArrayLike, nthreads: int = 0, nsamples: int = 1
    ) -> npt.NDArray[np.float32]:
        """The same, negative inside. `nsamples` is taken and not needed: one ray is exact."""
        scene, threads = self._asked(), nthreads or self._threads
        return scene.distance(query_points, signed=True, threads=threads).astype(np.float32)

    def compute_occupancy(
        self, query_points: npt.ArrayLike, nthreads: int = 0, nsamples: int = 1
    ) -> npt.NDArray[np.float32]:
        """1 inside, 0 outside."""
        return self._asked().contains(query_points, threads=nthreads or self._threads).astype(np.float32)

    @staticmethod
    def create_rays_pinhole(
        intrinsic_matrix: npt.ArrayLike, extrinsic_matrix: npt.ArrayLike, width_px: int, height_px: int
    ) -> npt.NDArray[np.float32]:
        """Rays through the middles of pixels, of shape (height, width, 6); pixel (0, 0) has its middle at 0.5, 0.5."""
        inner = np.linalg.inv(np.asarray(intrinsic_matrix, np.float64))
        outer = np.asarray(extrinsic_matrix, np.float64)
        x, y = np.meshgrid(np.arange(width_px) + 0.5, np.arange(height_px) + 0.5)
        ways = np.stack([x, y, np.ones_like(x)], -1) @ inner.T @ outer[:3, :3]
        eye = -outer[:3, :3].T @ outer[:3, 3]
        return np.concatenate([np.broadcast_to(eye, ways.shape), ways], -1).astype(np.float32)
