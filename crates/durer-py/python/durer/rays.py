"""Rays without pictures: meshes, meshes in places, and what rays meet there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Iterable, Literal, Optional, Sequence, TypeAlias, Union

import numpy as np
import numpy.typing as npt

from . import _durer
from ._arrays import Bools, Doubles, Floats, Ints, indices, matrix, rows, scalars, seen, vectors
from ._progress import Progress, watch

Preset: TypeAlias = Literal["fast", "balanced", "best"]

#: What `ray` gives for each ray.
RECORD = np.dtype(
    [("t", "f4"), ("triangle", "i4"), ("object", "i4"), ("uv", "f4", 2), ("normal", "f4", 3), ("point", "f4", 3)]
)


def _unit_normals(corners: Doubles) -> Doubles:
    """Normals of triangles with corners of shape (..., 3, 3); 0 for those without area."""
    normal = np.cross(corners[..., 1, :] - corners[..., 0, :], corners[..., 2, :] - corners[..., 0, :])
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    unit: Doubles = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    return unit


@dataclass(frozen=True, eq=False)
class Hits:
    """What rays meet first. All arrays have the shape of the rays, (n,) say, with the components of vectors behind it."""

    #: Position along the ray, in units of its direction's length; infinite where nothing is met.
    t: Floats
    #: Number of the triangle in its mesh; -1 where nothing is met.
    triangle: Ints
    #: Second and third barycentric coordinate: the point is (1 - u - v) a + u b + v c.
    uv: Floats
    _objects: Optional[Ints]
    _source: _Rays
    _origins: Floats
    _directions: Floats

    @property
    def hit(self) -> Bools:
        """Where something is met."""
        return self.triangle >= 0

    @cached_property
    def object(self) -> Ints:
        """Number of the object in its scene, 0 in a mesh; -1 where nothing is met."""
        return np.minimum(self.triangle, 0) if self._objects is None else self._objects

    @cached_property
    def point(self) -> Floats:
        """Where rays meet the surface, by the triangle's corners; not a number where nothing is met."""
        corners = self._source._corners(self.object, self.triangle)
        u, v = self.uv[..., 0:1].astype(np.float64), self.uv[..., 1:2].astype(np.float64)
        point = (1 - u - v) * corners[..., 0, :] + u * corners[..., 1, :] + v * corners[..., 2, :]
        return np.where(self.hit[..., None], point, np.nan).astype(np.float32)

    @cached_property
    def normal(self) -> Floats:
        """The triangle's normal, of length 1, to the side from which its corners go round counterclockwise; 0 where nothing is met."""
        normal = _unit_normals(self._source._corners(self.object, self.triangle))
        return np.where(self.hit[..., None], normal, 0).astype(np.float32)

    def record(self) -> npt.NDArray[np.void]:
        """All of it as one structured array, of type `RECORD`."""
        record = np.zeros(self.t.shape, RECORD)
        for name in RECORD.names or ():
            record[name] = getattr(self, name)
        return record

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        return f"<Hits of {self.t.size} rays: {int(self.hit.sum())} meet something>"


@dataclass(frozen=True, eq=False)
class AllHits:
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

    @property
    def offsets(self) -> npt.NDArray[np.int64]:
        """Where the hits of each ray begin; with one number more, where the last ones end."""
        return np.concatenate([np.zeros(1, np.int64), np.cumsum(self.count.reshape(-1))])

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


#: How many rays, origins, directions, t_min and t_max.
Asked: TypeAlias = tuple[int, Floats, Floats, Floats, Floats]


def asked(origins: Any, directions: Any, t_min: Any, t_max: Any) -> tuple[tuple[int, ...], Asked]:
    """The shape of rays, and their arrays: checked, and broadcast against each other."""
    origins, directions = vectors("origins", origins), vectors("directions", directions)
    try:
        shape = np.broadcast_shapes(origins.shape, directions.shape)[:-1]
    except ValueError:
        raise ValueError(
            f"origins and directions must have shapes that fit together, but have {origins.shape} and {directions.shape}"
        ) from None
    count = int(np.prod(shape))
    arrays: list[Floats] = []
    for array in (origins, directions):
        if array.size != 3 and array.shape[:-1] != shape:
            array = np.broadcast_to(array, (*shape, 3))
        arrays.append(rows(array, 3))
    return shape, (count, arrays[0], arrays[1], scalars("t_min", t_min, shape), scalars("t_max", t_max, shape))


class _Rays:
    """The questions that a mesh and a scene answer alike.

    Origins and directions have the shape (..., 3) and are broadcast against each other: one origin for all directions, say.
    Directions need not have length 1: `t` is in units of it. Hits lie in the open interval from `t_min` to `t_max`, each of
    which is one number or has the shape of the rays. Rays that are not finite, or have no direction, hit nothing. Computed in
    single precision with exact edges: a ray through an edge or vertex crosses exactly one of the triangles around it. Rays that
    are neighbours in the array are fastest if they are neighbours in space.

    `threads` says how many may work, None all of the machine; answers have the same bits with any number. `progress` is called
    with how much is done of how much; without one, long work shows a line on a terminal. Ctrl-C stops it.
    """

    _tree: _durer.Tree

    def _corners(self, objects: Ints, triangles: Ints) -> Doubles:
        raise NotImplementedError

    def closest(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
        *,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Hits:
        """What each ray meets first."""
        shape, rays = asked(origins, directions, t_min, t_max)
        t, triangle, objects, uv = self._tree.closest(rays, threads_asked(threads), watch(progress))
        return Hits(
            t.reshape(shape),
            triangle.reshape(shape),
            uv.reshape(*shape, 2),
            None if objects is None else objects.reshape(shape),
            self,
            rays[1],
            rays[2],
        )

    def ray(self, origins: npt.ArrayLike, directions: npt.ArrayLike, **options: Any) -> npt.NDArray[np.void]:
        """As `closest`, as one structured array with the fields t, triangle, object, uv, normal and point."""
        return self.closest(origins, directions, **options).record()

    def occluded(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
        *,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Bools:
        """Whether each ray meets anything: faster than `closest`. With directions from point to point and `t_max` 1: whether
        they do not see each other."""
        shape, rays = asked(origins, directions, t_min, t_max)
        return self._tree.occluded(rays, threads_asked(threads), watch(progress)).reshape(shape)

    def count(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
        *,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Ints:
        """How many triangles each ray crosses: exact, also through edges and vertices."""
        shape, rays = asked(origins, directions, t_min, t_max)
        return self._tree.count(rays, threads_asked(threads), watch(progress)).reshape(shape)

    def all_hits(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
        *,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> AllHits:
        """All that each ray meets, from near to far."""
        shape, rays = asked(origins, directions, t_min, t_max)
        count, (t, triangle, object, uv) = self._tree.all_hits(rays, threads_asked(threads), watch(progress))
        ray = np.repeat(np.arange(len(count)), count)
        return AllHits(ray, count.reshape(shape), t, triangle, object, uv.reshape(-1, 2))

    def contains(
        self, points: npt.ArrayLike, *, threads: Optional[int] = None, progress: Progress = None
    ) -> Bools:
        """Whether points, of shape (..., 3), lie inside: by the parity of crossings, which is exact for closed meshes. In a
        scene, inside any of its objects."""
        places = vectors("points", points)
        answer = self._tree.contains(rows(places, 3), threads_asked(threads), watch(progress))
        return answer.reshape(places.shape[:-1])

    def nearest(
        self,
        points: npt.ArrayLike,
        within: float = np.inf,
        *,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Nearest:
        """The nearest point of the surface for each point, of shape (..., 3), unless it is further away than `within`."""
        raise NotImplementedError

    def distance(
        self, points: npt.ArrayLike, *, signed: bool = False, threads: Optional[int] = None, progress: Progress = None
    ) -> Doubles:
        """How far points are from the surface; if `signed`, negative inside, for closed meshes."""
        distance = self.nearest(points, threads=threads, progress=progress).distance
        if signed:
            distance[self.contains(points, threads=threads)] *= -1
        return distance

    @property
    def bounds(self) -> Floats:
        """Least and greatest corner of the box around everything: shape (2, 3)."""
        return np.array(self._tree.bounds(), np.float32)

    @property
    def nbytes(self) -> int:
        """Bytes that the tree takes."""
        return self._tree.bytes()


def threads_asked(threads: Optional[int]) -> Optional[int]:
    if threads is not None and threads < 1:
        raise ValueError(f"threads must be 1 or more, or None for all, but is {threads}")
    return threads


class Mesh(_Rays):
    __doc__ = (_Rays.__doc__ or "").replace(
        "The questions that a mesh and a scene answer alike.",
        """Triangles, ready for rays.

    `vertices` has the shape (n, 3) and `faces` (m, 3): numbers of vertices. Float32 and uint32 arrays in C order are taken as they
    are, all others are copied to these. `preset` says how long the tree is built for: "fast", "balanced" or "best", for many rays.
    """,
    )

    #: Corners, float32 of shape (n, 3).
    vertices: Floats
    #: Corners of triangles, uint32 of shape (m, 3).
    faces: npt.NDArray[np.uint32]

    def __init__(
        self,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        preset: Preset = "balanced",
        *,
        threads: Optional[int] = None,
    ) -> None:
        self.vertices = np.ascontiguousarray(vectors("vertices", vertices))
        if self.vertices.ndim != 2:
            raise ValueError(f"vertices must have the shape (n, 3), but has {self.vertices.shape}")
        self.faces = indices("faces", faces)
        self._tree = _durer.Tree.mesh(self.vertices, self.faces, preset, threads_asked(threads))

    def __repr__(self) -> str:
        return f"<Mesh of {len(self.faces)} triangles>"

    def _corners(self, objects: Ints, triangles: Ints) -> Doubles:
        if not len(self.faces):
            return np.zeros((*triangles.shape, 3, 3))
        return self.vertices[self.faces[triangles]].astype(np.float64)

    def nearest(
        self,
        points: npt.ArrayLike,
        within: float = np.inf,
        *,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Nearest:
        places = vectors("points", points)
        shape = places.shape[:-1]
        found = self._tree.nearest(rows(places, 3), within, threads_asked(threads), watch(progress))
        distance, triangle, point, uv = found
        triangle = triangle.reshape(shape)
        objects = np.where(triangle >= 0, np.int32(0), np.int32(-1))
        return Nearest(distance.reshape(shape), point.reshape(*shape, 3), triangle, objects, uv.reshape(*shape, 2))

    nearest.__doc__ = _Rays.nearest.__doc__

    @cached_property
    def open_edges(self) -> int:
        """How many edges belong to an odd number of triangles, corners being the same where they lie at the same place. 0 for a
        closed mesh, whose inside `contains` knows."""
        _, place = np.unique(self.vertices + np.float32(0), axis=0, return_inverse=True)
        corners = place.reshape(-1)[self.faces.astype(np.int64)]
        edges = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
        edges = edges[edges[:, 0] != edges[:, 1]]
        return int((np.unique(edges, axis=0, return_counts=True)[1] % 2).sum())

    @property
    def is_closed(self) -> bool:
        """Whether it has an inside: no open edge."""
        return self.open_edges == 0

    @property
    def normals(self) -> Floats:
        """The normals of all triangles, of length 1; 0 for those without area."""
        zeros = np.zeros(len(self.faces), np.int32)
        return _unit_normals(self._corners(zeros, np.arange(len(self.faces), dtype=np.int32))).astype(np.float32)


Placed: TypeAlias = Union[Mesh, tuple[Mesh, npt.ArrayLike]]


class Scene(_Rays):
    __doc__ = (_Rays.__doc__ or "").replace(
        "The questions that a mesh and a scene answer alike.",
        """Meshes in places, ready for rays. Each mesh is in memory once, however often it is placed.

    `objects` are meshes, or pairs of a mesh and the matrix, 4 x 4 or 3 x 4, that takes its points to the world: any affine map that
    can be inverted. Of hits at the same `t` that of the object with the least number counts.
    """,
    )

    #: The mesh of each object.
    meshes: Sequence[Mesh]
    #: The map of each object to the world: shape (n, 3, 4).
    matrices: Doubles

    def __init__(self, objects: Iterable[Placed]) -> None:
        meshes, matrices = [], []
        for i, placed in enumerate(objects):
            mesh, place = placed if isinstance(placed, tuple) else (placed, np.eye(4))
            if not isinstance(mesh, Mesh):
                raise TypeError(f"object {i} must be a Mesh or a pair of a Mesh and a matrix, but is {type(mesh).__name__}")
            meshes.append(mesh)
            matrices.append(matrix(f"the matrix of object {i}", place))
        self.meshes = tuple(meshes)
        self.matrices = np.array(matrices, np.float64).reshape(-1, 3, 4)
        trees = [mesh._tree for mesh in self.meshes]
        self._tree = _durer.Tree.placed(trees, rows(self.matrices, 12))

    def __repr__(self) -> str:
        return f"<Scene of {len(self.meshes)} objects>"

    def _corners(self, objects: Ints, triangles: Ints) -> Doubles:
        corners = np.zeros((*triangles.shape, 3, 3))
        for i, mesh in enumerate(self.meshes):
            there = objects == i
            if there.any():
                local = mesh._corners(objects[there], triangles[there])
                corners[there] = local @ self.matrices[i][:, :3].T + self.matrices[i][:, 3]
        return corners

    @cached_property
    def _flat(self) -> tuple[Mesh, npt.NDArray[np.int64]]:
        """All objects as one mesh, and where the triangles of each begin."""
        moved = [m.vertices @ a[:, :3].T + a[:, 3] for m, a in zip(self.meshes, self.matrices)]
        first = np.cumsum([0] + [len(mesh.vertices) for mesh in self.meshes])
        faces = [mesh.faces.astype(np.int64) + start for mesh, start in zip(self.meshes, first)]
        starts = np.cumsum([0] + [len(mesh.faces) for mesh in self.meshes])
        none = np.zeros((0, 3))
        return Mesh(np.concatenate([none, *moved]), np.concatenate([none.astype(np.int64), *faces])), starts

    def nearest(
        self,
        points: npt.ArrayLike,
        within: float = np.inf,
        *,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Nearest:
        mesh, starts = self._flat
        near = mesh.nearest(points, within, threads=threads, progress=progress)
        objects = np.where(near.triangle >= 0, np.searchsorted(starts, near.triangle, side="right") - 1, -1)
        triangle = np.where(near.triangle >= 0, near.triangle - starts[np.maximum(objects, 0)], -1).astype(np.int32)
        return Nearest(near.distance, near.point, triangle, objects.astype(np.int32), near.uv)

    nearest.__doc__ = (_Rays.nearest.__doc__ or "") + " The first such question makes one mesh of all objects."


def rays_of(value: Any) -> tuple[Floats, Floats]:
    """Origins and directions of rays that are rows of six numbers, as Open3D has them."""
    array = seen("rays", value)
    if array.ndim == 0 or array.shape[-1] != 6:
        raise ValueError(f"rays must have the shape (..., 6), but has {array.shape}")
    array = np.asarray(array, np.float32)
    return array[..., :3], array[..., 3:]
