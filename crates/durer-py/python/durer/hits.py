"""Results of ray queries: hits, with points, normals, and origins of secondary rays."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Optional, Protocol

import numpy as np
import numpy.typing as npt

from . import _durer
from ._arrays import Bools, Doubles, Floats, Ints, Points, as_vectors, rows

#: Type of the array elements that `Mesh.ray` and `Scene.ray` return.
RECORD = np.dtype(
    [("t", "f4"), ("triangle", "i4"), ("object", "i4"), ("uv", "f4", 2), ("normal", "f4", 3), ("point", "f4", 3)]
)


class _Target(Protocol):
    """The mesh or scene that was queried."""

    _tree: _durer.Tree
    #: True if it is so far from the origin that points in single precision are too coarse.
    _far: bool


class _SurfaceHits:
    """Attributes of hits that are computed on demand: points, normals, and origins of secondary
    rays."""

    triangle: Ints
    uv: Floats
    _source: _Target
    _threads: Optional[int]

    def _flat(self, shape: tuple[int, ...]) -> tuple[Optional[Ints], Ints, Floats]:
        """Returns the objects (if the target is a scene), the triangles, and u and v, broadcast to
        a shape and flattened."""
        raise NotImplementedError

    @cached_property
    def point(self) -> Points:
        """Hit points, of shape (..., 3), interpolated from the triangles' corners; NaN for misses.
        Float32, or float64 if the mesh or scene is far from the origin. Use `leave` for origins of
        secondary rays."""
        shape, source = self.triangle.shape, self._source
        return _durer.hit_points(source._tree, self._flat(shape), source._far, self._threads).reshape(*shape, 3)

    @cached_property
    def normal(self) -> Floats:
        """Unit normals of the triangles, of shape (..., 3), on the side from which the mesh's
        corners are counterclockwise (outwards), also for mirrored instances; 0 for misses.
        Float32."""
        shape = self.triangle.shape
        return _durer.hit_normals(self._source._tree, self._flat(shape), self._threads).reshape(*shape, 3)

    def leave(self, directions: npt.ArrayLike) -> Doubles:
        """Returns origins for secondary rays in the given directions. Each origin is off the
        surface, on the side that the ray goes to, by no more than the rounding error. So a ray
        never hits the surface that it leaves, and you need not choose an epsilon.

        Directions, of shape (..., 3), are broadcast against the hits:
        `hits[:, None].leave(directions)` takes several directions per hit. Origins are NaN for
        misses, and rays from there hit nothing. The result is float64, because single precision is
        not enough in scenes and far from the origin.
        """
        ways = as_vectors("directions", directions)
        try:
            shape = np.broadcast_shapes(self.triangle.shape, ways.shape[:-1])
        except ValueError:
            raise ValueError(
                f"directions must be broadcastable with the shape {(*self.triangle.shape, 3)}, but have the shape {ways.shape}"
            ) from None
        ways = rows(np.broadcast_to(ways, (*shape, 3)), 3)
        return _durer.secondary_origins(self._source._tree, self._flat(shape), ways, self._threads).reshape(*shape, 3)


def _row(array: Any, shape: tuple[int, ...]) -> Any:
    return np.ascontiguousarray(array if array.shape == shape else np.broadcast_to(array, shape)).reshape(-1)


@dataclass(frozen=True, eq=False)
class Hits(_SurfaceHits):
    """First hits of rays with a mesh or a scene. All arrays have the shape of the rays, for example
    (n,), followed by the components of vectors. Hits can be indexed like arrays of that shape:
    `hits[hits.hit]`, `hits[:, None]`.

    t: distance along the ray, in units of the length of its direction; infinite for misses.
    Float32.

    triangle: index of the triangle in its mesh, a row of `faces`; -1 for misses. Int32.

    uv: u and v, each from 0 to 1, the weights of the triangle's corners 1 and 2, counted from 0.
    The point is (1 - u - v) a + u b + v c for the corners a, b and c in the order of `faces`. 0 for
    misses. Float32 of shape (..., 2).

    hit, object, point, normal: see below. They are computed when they are first read.
    """

    t: Floats
    triangle: Ints
    uv: Floats
    _objects: Optional[Ints]
    _source: _Target
    _threads: Optional[int] = None

    @property
    def hit(self) -> Bools:
        """Mask of the rays that hit something."""
        return self.triangle >= 0

    @cached_property
    def object(self) -> Ints:
        """Index of the object in the scene, or 0 for a mesh; -1 for misses. Int32."""
        return np.minimum(self.triangle, 0) if self._objects is None else self._objects

    def _flat(self, shape: tuple[int, ...]) -> tuple[Optional[Ints], Ints, Floats]:
        objects = None if self._objects is None else _row(self._objects, shape)
        return objects, _row(self.triangle, shape), _row(self.uv, (*shape, 2)).reshape(-1, 2)

    def record(self) -> npt.NDArray[np.void]:
        """Returns all attributes as one structured array of type `RECORD`."""
        record = np.zeros(self.t.shape, RECORD)
        for name in RECORD.names or ():
            record[name] = getattr(self, name)
        return record

    def __getitem__(self, index: Any) -> Hits:
        numbers = np.arange(self.t.size).reshape(self.t.shape)[index]
        objects = None if self._objects is None else np.asarray(self._objects.reshape(-1)[numbers])
        uv = self.uv.reshape(-1, 2)[numbers]
        t, triangle = np.asarray(self.t.reshape(-1)[numbers]), np.asarray(self.triangle.reshape(-1)[numbers])
        return Hits(t, triangle, uv, objects, self._source, self._threads)

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        return f"<Hits of {self.t.size} rays: {int(self.hit.sum())} hit something>"


@dataclass(frozen=True, eq=False)
class AllHits(_SurfaceHits):
    """All hits of rays with a mesh or a scene, ray by ray, and for each ray by increasing distance.
    All arrays except `count` and `offsets` have one row per hit.

    ray: index of the hit's ray in the flattened array of rays, in ascending order. Int64.

    count: number of hits of each ray, in the shape of the rays. Int64.

    t: distance along the ray, in units of the length of its direction. Float32.

    triangle: index of the triangle in its mesh. Int32.

    object: index of the object in the scene, or 0 for a mesh. Int32.

    uv: weights of the triangle's corners 1 and 2, as in `Hits`. Float32 of shape (hits, 2).

    offsets, point, normal: see below.

    The hits of ray `i` of a flat array of rays are rows `offsets[i]` to `offsets[i + 1]`.
    """

    ray: npt.NDArray[np.int64]
    count: npt.NDArray[np.int64]
    t: Floats
    triangle: Ints
    object: Ints
    uv: Floats
    _source: _Target
    _threads: Optional[int] = None

    @property
    def offsets(self) -> npt.NDArray[np.int64]:
        """Offset of the first hit of each ray, followed by the total number of hits."""
        return np.concatenate([np.zeros(1, np.int64), np.cumsum(self.count.reshape(-1))])

    def _flat(self, shape: tuple[int, ...]) -> tuple[Optional[Ints], Ints, Floats]:
        return _row(self.object, shape), _row(self.triangle, shape), _row(self.uv, (*shape, 2)).reshape(-1, 2)

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        return f"<AllHits of {self.count.size} rays: {len(self)}>"


@dataclass(frozen=True, eq=False)
class Nearest:
    """For query points, the nearest points on the surface of a mesh or a scene. All arrays have the
    shape of the query points without its last axis, followed by the components of vectors.

    distance: distance to the surface, 0 or more, in the unit of the coordinates; infinite if no
    point of the surface is within the limit. Float64.

    point: nearest point; NaN if none is within the limit. Float64 of shape (..., 3).

    triangle: index of the triangle in its mesh; -1 if none is within the limit. Int32.

    object: index of the object in the scene, or 0 for a mesh; -1 if none is within the limit. Int32.

    uv: weights of the triangle's corners 1 and 2, as in `Hits`. Float64 of shape (..., 2).
    """

    distance: Doubles
    point: Doubles
    triangle: Ints
    object: Ints
    uv: Doubles

    def __repr__(self) -> str:
        return f"<Nearest of {self.distance.size} points>"
