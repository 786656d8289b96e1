"""What rays meet: where, of what, and where they go on."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Optional, Protocol

import numpy as np
import numpy.typing as npt

from . import _durer
from ._arrays import Bools, Doubles, Floats, Ints, Places, rows, vectors

#: What `ray` gives for each ray.
RECORD = np.dtype(
    [("t", "f4"), ("triangle", "i4"), ("object", "i4"), ("uv", "f4", 2), ("normal", "f4", 3), ("point", "f4", 3)]
)


class _Source(Protocol):
    """What was asked: a mesh, or a scene."""

    _tree: _durer.Tree
    #: Whether it is so far from the origin that points in single precision say too little.
    _far: bool


class _Met:
    """What is known of the places where rays met a surface."""

    triangle: Ints
    uv: Floats
    _source: _Source
    _threads: Optional[int]

    def _flat(self, shape: tuple[int, ...]) -> tuple[Optional[Ints], Ints, Floats]:
        """Objects, if there are any, triangles, and u and v, as if the hits had such a shape."""
        raise NotImplementedError

    @cached_property
    def point(self) -> Places:
        """Where rays meet the surface, by the triangle's corners; not a number where nothing is met. Float32, or float64 where the mesh
        or scene is far from the origin. A ray that goes on from there starts at `leave`."""
        shape, source = self.triangle.shape, self._source
        return _durer.met_points(source._tree, self._flat(shape), source._far, self._threads).reshape(*shape, 3)

    @cached_property
    def normal(self) -> Floats:
        """The triangle's normal, of length 1, to the side from which its corners go round counterclockwise in its mesh, outwards say,
        also where that is mirrored; 0 where nothing is met."""
        shape = self.triangle.shape
        return _durer.met_normals(self._source._tree, self._flat(shape), self._threads).reshape(*shape, 3)

    def leave(self, directions: npt.ArrayLike) -> Doubles:
        """Where rays start that go on from here in such directions: off the surface, on the side to which each goes, by no more than
        what is rounded. So no ray meets the surface that it leaves, and no distance has to be chosen.

        Directions, of shape (..., 3), are broadcast against the hits: `hits[:, None].leave(directions)` takes several for each. Not
        numbers where nothing is met: rays from there meet nothing. Float64: far from the origin, and in scenes, single precision is
        too little.
        """
        ways = vectors("directions", directions)
        try:
            shape = np.broadcast_shapes(self.triangle.shape, ways.shape[:-1])
        except ValueError:
            raise ValueError(
                f"directions must have a shape that fits {(*self.triangle.shape, 3)}, but has {ways.shape}"
            ) from None
        ways = rows(np.broadcast_to(ways, (*shape, 3)), 3)
        return _durer.met_leave(self._source._tree, self._flat(shape), ways, self._threads).reshape(*shape, 3)


def _row(array: Any, shape: tuple[int, ...]) -> Any:
    return np.ascontiguousarray(array if array.shape == shape else np.broadcast_to(array, shape)).reshape(-1)


@dataclass(frozen=True, eq=False)
class Hits(_Met):
    """What rays meet first. All arrays have the shape of the rays, (n,) say, with the components of vectors behind it. Hits can be
    indexed as arrays of that shape: `hits[hits.hit]`, `hits[:, None]`."""

    #: Position along the ray, in units of its direction's length; infinite where nothing is met.
    t: Floats
    #: Number of the triangle in its mesh; -1 where nothing is met.
    triangle: Ints
    #: Second and third barycentric coordinate: the point is (1 - u - v) a + u b + v c.
    uv: Floats
    _objects: Optional[Ints]
    _source: _Source
    _threads: Optional[int] = None

    @property
    def hit(self) -> Bools:
        """Where something is met."""
        return self.triangle >= 0

    @cached_property
    def object(self) -> Ints:
        """Number of the object in its scene, 0 in a mesh; -1 where nothing is met."""
        return np.minimum(self.triangle, 0) if self._objects is None else self._objects

    def _flat(self, shape: tuple[int, ...]) -> tuple[Optional[Ints], Ints, Floats]:
        objects = None if self._objects is None else _row(self._objects, shape)
        return objects, _row(self.triangle, shape), _row(self.uv, (*shape, 2)).reshape(-1, 2)

    def record(self) -> npt.NDArray[np.void]:
        """All of it as one structured array, of type `RECORD`."""
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
        return f"<Hits of {self.t.size} rays: {int(self.hit.sum())} meet something>"


@dataclass(frozen=True, eq=False)
class AllHits(_Met):
    """All that rays meet, ray by ray, each from near to far."""

    #: Number of the ray of each hit, in the order of the rays.
    ray: npt.NDArray[np.int64]
    #: How many hits each ray has, in the shape of the rays.
    count: npt.NDArray[np.int64]
    #: As in `Hits`, one row for each hit.
    t: Floats
    triangle: Ints
    object: Ints
    uv: Floats
    _source: _Source
    _threads: Optional[int] = None

    @property
    def offsets(self) -> npt.NDArray[np.int64]:
        """Where the hits of each ray begin; with one number more, where the last ones end."""
        return np.concatenate([np.zeros(1, np.int64), np.cumsum(self.count.reshape(-1))])

    def _flat(self, shape: tuple[int, ...]) -> tuple[Optional[Ints], Ints, Floats]:
        return _row(self.object, shape), _row(self.triangle, shape), _row(self.uv, (*shape, 2)).reshape(-1, 2)

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        return f"<AllHits of {self.count.size} rays: {len(self)}>"


@dataclass(frozen=True, eq=False)
class Nearest:
    """The points of a surface that are nearest to some points."""

    #: How far it is, 0 or more; infinite where none is near enough.
    distance: Doubles
    #: Where it is; not a number where none is near enough.
    point: Doubles
    #: Number of the triangle, -1 where none is near enough.
    triangle: Ints
    #: Number of the object in its scene, 0 in a mesh.
    object: Ints
    #: Second and third barycentric coordinate.
    uv: Doubles

    def __repr__(self) -> str:
        return f"<Nearest of {self.distance.size} points>"
