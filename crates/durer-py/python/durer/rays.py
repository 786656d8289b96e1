"""Ray queries on meshes and on scenes of instanced meshes."""

from __future__ import annotations

import math
import os
import warnings
from functools import cached_property
from pathlib import Path
from typing import Any, Iterable, Literal, Mapping, Optional, Sequence, TypeAlias, Union

import numpy as np
import numpy.typing as npt

from . import _durer
from ._arrays import Bools, Doubles, Floats, Ints, Points, as_array, as_indices, as_matrix, as_points, as_scalars, as_vectors, rows
from ._errors import SceneError, with_hints, with_python_names
from ._mesh import FAR, centered, open_edges
from ._options import pairs
from ._progress import Progress, watch
from .hits import AllHits, Hits, Nearest

Preset: TypeAlias = Literal["fast", "balanced", "best"]

#: Rays for the native module: their number, origins, directions, t_min and t_max.
RayArrays: TypeAlias = tuple[int, Points, Floats, Floats, Floats]


def check_rays(origins: Any, directions: Any, t_min: Any, t_max: Any) -> tuple[tuple[int, ...], RayArrays]:
    """Checks the arguments of a ray query. Returns the broadcast shape of the rays, and their
    arrays."""
    starts, ways = as_points("origins", origins), as_vectors("directions", directions)
    shape = starts.shape[:-1]
    if starts.shape != ways.shape:
        try:
            shape = np.broadcast_shapes(starts.shape, ways.shape)[:-1]
        except ValueError:
            raise ValueError(
                f"origins and directions must be broadcastable, but have the shapes {starts.shape} and {ways.shape}"
            ) from None
    starts, ways = (_spread(array, shape) for array in (starts, ways))
    return shape, (math.prod(shape), starts, ways, as_scalars("t_min", t_min, shape), as_scalars("t_max", t_max, shape))


def _spread(array: Any, shape: tuple[int, ...]) -> Any:
    if array.size != 3 and array.shape[:-1] != shape:
        array = np.broadcast_to(array, (*shape, 3))
    return rows(array, 3)


@with_hints
class _Rays:
    """Queries that meshes and scenes share.

    Origins and directions have the shape (..., 3) and are broadcast against each other, for example
    one origin for all directions. Directions need not be unit length: `t` is in units of their
    length. Hits lie in the open interval from `t_min` to `t_max`; each is one number or has the
    shape of the rays. Rays that are not finite or have a zero direction hit nothing. Queries use
    single precision with exact edge tests: a ray through an edge or vertex crosses exactly one of
    the triangles around it. Origins and points in double precision are rounded only after they have
    been made relative to the mesh, or to the centre of its bounds if that is far away. Queries are
    fastest if neighbours in the array are neighbours in space.

    `threads` limits the number of threads; None uses all processors. Results have the same bits for
    any number. `progress` is a function that is called with the finished and the total work, every
    0.05 seconds and at the end; an exception in it stops the query. By default, long queries show a
    progress line on a terminal; with False, they do not. Ctrl-C stops a query.
    """

    _tree: _durer.Tree
    #: True if it is so far from the origin that points in single precision are too coarse.
    _far: bool

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
        """Returns the first hit of each ray.

        >>> hits = mesh.closest([(0, 0, 5), (9, 0, 5)], (0, 0, -1))
        >>> hits.t, hits.hit
        (array([ 4., inf], dtype=float32), array([ True, False]))
        >>> hits.point[0], hits.normal[0]
        (array([0., 0., 1.], dtype=float32), array([0., 0., 1.], dtype=float32))
        """
        shape, rays = check_rays(origins, directions, t_min, t_max)
        t, triangle, objects, uv = self._tree.closest(rays, check_threads(threads), watch(progress, rays[0]))
        objects = None if objects is None else objects.reshape(shape)
        return Hits(t.reshape(shape), triangle.reshape(shape), uv.reshape(*shape, 2), objects, self, threads)

    def ray(self, origins: npt.ArrayLike, directions: npt.ArrayLike, **options: Any) -> npt.NDArray[np.void]:
        """Returns the first hit of each ray as a structured array with the fields t, triangle,
        object, uv, normal and point.

        >>> mesh.ray((0, 0, 5), (0, 0, -1))["t"]
        array(4., dtype=float32)
        """
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
        """Returns True for each ray that hits anything. Faster than `closest`. To test whether two
        points see each other, use their difference as the direction and `t_max` 1.

        >>> a, b = np.array((0, 0, 5)), np.array((0, 0, -5))
        >>> bool(mesh.occluded(a, b - a, t_max=1))
        True
        """
        shape, rays = check_rays(origins, directions, t_min, t_max)
        return self._tree.occluded(rays, check_threads(threads), watch(progress, rays[0])).reshape(shape)

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
        """Returns the number of triangles that each ray crosses, which is exact even through edges
        and vertices.

        >>> int(mesh.count((0, 0, 5), (0, 0, -1)))  # through the diagonals of two faces
        2
        """
        shape, rays = check_rays(origins, directions, t_min, t_max)
        return self._tree.count(rays, check_threads(threads), watch(progress, rays[0])).reshape(shape)

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
        """Returns all hits of each ray, sorted by distance.

        >>> mesh.all_hits((0, 0, 5), (0, 0, -1)).t
        array([4., 6.], dtype=float32)
        """
        shape, rays = check_rays(origins, directions, t_min, t_max)
        count, (t, triangle, object, uv) = self._tree.all_hits(rays, check_threads(threads), watch(progress, rays[0]))
        ray = np.repeat(np.arange(len(count)), count)
        return AllHits(ray, count.reshape(shape), t, triangle, object, uv.reshape(-1, 2), self, threads)

    def contains(
        self, points: npt.ArrayLike, *, threads: Optional[int] = None, progress: Progress = None
    ) -> Bools:
        """Returns True for each point, of shape (..., 3), that is inside, by the parity of
        crossings, which is exact for closed meshes. In a scene, a point is inside if any object
        contains it.

        >>> mesh.contains([(0, 0, 0), (0, 0, 3)])
        array([ True, False])
        """
        at = as_points("points", points)
        answer = self._tree.contains(rows(at, 3), check_threads(threads), watch(progress))
        return answer.reshape(at.shape[:-1])

    def nearest(
        self,
        points: npt.ArrayLike,
        within: float = np.inf,
        *,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Nearest:
        """Returns the point on the surface nearest to each query point, of shape (..., 3), within
        the distance `within`.

        >>> nearest = mesh.nearest((0.25, 0.5, 3))
        >>> nearest.point, float(nearest.distance)
        (array([0.25, 0.5 , 1.  ]), 2.0)
        """
        raise NotImplementedError

    def distance(
        self, points: npt.ArrayLike, *, signed: bool = False, threads: Optional[int] = None, progress: Progress = None
    ) -> Doubles:
        """Returns the distance of each point from the surface. If `signed`, distances are negative
        inside, as defined by `contains`, which needs closed meshes.

        >>> mesh.distance([(0, 0, 0), (0, 0, 3)], signed=True)
        array([-1.,  2.])
        """
        distance = self.nearest(points, threads=threads, progress=progress).distance
        if signed:
            distance[self.contains(points, threads=threads)] *= -1
        return distance

    @property
    def bounds(self) -> Points:
        """Lower and upper corner of the bounding box, of shape (2, 3). For a scene, the union of
        the transformed boxes of its meshes, which can be larger than the tightest box."""
        return np.array(self._tree.bounds(), np.float32)

    @property
    def nbytes(self) -> int:
        """Size of the tree in bytes."""
        return self._tree.bytes()


def check_threads(threads: Optional[int]) -> Optional[int]:
    if threads is not None and (not isinstance(threads, (int, np.integer)) or threads < 1):
        raise ValueError(f"threads must be a whole number of 1 or more, or None for all processors, but is {threads!r}")
    return threads


@with_hints
class Mesh(_Rays):
    __doc__ = (_Rays.__doc__ or "").replace(
        "Queries that meshes and scenes share.",
        """A triangle mesh, ready for ray queries.

    `vertices` has the shape (n, 3) and `faces` (m, 3): indices of vertices. Both are copied and
    immutable. An object with these two attributes, such as a `trimesh.Trimesh`, can be passed
    alone: `Mesh(trimesh.load("part.stl"))`. Vertices are stored in single precision; if they are far from the origin compared
    with their extent, relative to the centre of their bounds, so that no precision is lost.
    Triangles with a corner that is not finite are ignored. `preset` is the effort of the build:
    "fast", "balanced" or "best". The slower "best" pays off for many rays.

    >>> mesh = durer.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> mesh.closest((0.2, 0.2, 5), (0, 0, -1)).t
    array(5., dtype=float32)
    """,
    )

    #: Corners of triangles, uint32 of shape (m, 3).
    faces: npt.NDArray[np.uint32]
    _preset: Preset

    def __init__(
        self,
        vertices: Any,
        faces: Optional[npt.ArrayLike] = None,
        preset: Preset = "balanced",
        *,
        threads: Optional[int] = None,
    ) -> None:
        if faces is None:
            if not hasattr(vertices, "vertices") or not hasattr(vertices, "faces"):
                raise TypeError("faces are missing: pass vertices and faces, or one object that has both, such as a Trimesh")
            vertices, faces = vertices.vertices, vertices.faces
        given = as_points("vertices", vertices)
        if given.ndim != 2:
            raise ValueError(f"vertices must have the shape (n, 3), but has {given.shape}")
        self._build(*centered(given), as_indices("faces", faces), preset, threads)

    @classmethod
    def from_file(cls, path: Union[str, os.PathLike[str]], preset: Preset = "balanced", **reading: Any) -> Mesh:
        """Reads all meshes of a file as one mesh in world space: OBJ, PLY, STL, OFF, 3MF, glTF,
        OpenUSD, COLLADA, and any scene that the command reads. Shapes such as spheres become
        triangles; planes and solids are left out with a warning. Options are those of `durer.load`.
        Raises SceneError with file, line and column if the file is invalid or has no triangles.

        >>> durer.Mesh.from_file("scenes/meshes/durer-solid.obj").is_closed
        True
        """
        given = pairs(reading, True)
        corners, faces, left_out = with_python_names(lambda: _durer.read_mesh(Path(path), given))
        if len(faces) == 0:
            raise SceneError(f"{os.fspath(path)}: error: no triangles", "[]")
        if left_out:
            what = f"{left_out} objects of {os.fspath(path)} are planes or solids and were left out"
            warnings.warn(what, stacklevel=2)
        return cls(corners.reshape(-1, 3), faces.reshape(-1, 3), preset)

    def _build(
        self, own: Floats, center: Doubles, faces: npt.NDArray[np.uint32], preset: Preset, threads: Optional[int] = None
    ) -> None:
        self._set(own, center, faces, preset)
        self._tree = _durer.Tree.from_mesh(own, faces, tuple(center.tolist()), preset, check_threads(threads))

    def _set(self, own: Floats, center: Doubles, faces: npt.NDArray[np.uint32], preset: Preset) -> None:
        own.setflags(write=False)
        faces.setflags(write=False)
        self._own, self._center, self.faces, self._preset = own, center, faces, preset
        self._far = bool(center.any())

    @staticmethod
    def _restore(own: Floats, center: Doubles, faces: npt.NDArray[np.uint32], preset: Preset) -> Mesh:
        mesh = Mesh.__new__(Mesh)
        mesh._build(own, center, faces, preset)
        return mesh

    def __reduce__(self) -> Any:
        return Mesh._restore, (self._own, self._center, self.faces, self._preset)

    def __repr__(self) -> str:
        return f"<Mesh of {len(self.faces)} triangles>"

    def refit(self, vertices: npt.ArrayLike) -> Mesh:
        """Returns the mesh with moved vertices, which must have the same number. Its tree is a
        refitted copy of this mesh's tree. Refitting is much faster than building, but rays become
        slower the farther vertices move. The results are those of a new mesh.

        >>> moved = mesh.refit(mesh.vertices + (0, 0, 1))
        >>> moved.closest((0, 0, 5), (0, 0, -1)).t
        array(3., dtype=float32)
        """
        given = as_points("vertices", vertices)
        if given.shape != self._own.shape:
            raise ValueError(f"vertices must have the shape {self._own.shape}, but has {given.shape}")
        own, center = centered(given)
        mesh = Mesh.__new__(Mesh)
        # The tree lacks triangles that were not finite when it was built, so it cannot be refitted
        # if they become finite.
        if not (np.isfinite(own).all() and np.isfinite(self._own).all()):
            mesh._build(own, center, self.faces, self._preset)
            return mesh
        mesh._set(own, center, self.faces, self._preset)
        mesh._tree = self._tree.refitted(own, self.faces, tuple(center.tolist()))
        return mesh

    @cached_property
    def vertices(self) -> Points:
        """Vertices as used by queries, of shape (n, 3): float32, or float64 if they are far from
        the origin."""
        if not self._far:
            return self._own
        vertices = self._own + self._center
        vertices.setflags(write=False)
        return vertices

    @property
    def bounds(self) -> Points:
        bounds = np.array(self._tree.bounds(), np.float32)
        return bounds + self._center if self._far else bounds

    bounds.__doc__ = _Rays.bounds.__doc__

    def nearest(
        self,
        points: npt.ArrayLike,
        within: float = np.inf,
        *,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Nearest:
        at = as_points("points", points)
        shape = at.shape[:-1]
        found = self._tree.nearest(rows(at, 3), within, check_threads(threads), watch(progress))
        distance, triangle, point, uv = found
        triangle = triangle.reshape(shape)
        objects = np.where(triangle >= 0, np.int32(0), np.int32(-1))
        return Nearest(distance.reshape(shape), point.reshape(*shape, 3), triangle, objects, uv.reshape(*shape, 2))

    nearest.__doc__ = _Rays.nearest.__doc__

    def surface(self, triangle: npt.ArrayLike, uv: npt.ArrayLike) -> Hits:
        """Returns points on the surface as hits with `t` 0, which have `point`, `normal` and
        `leave`. A point is given by its triangle, of shape (...), and by u and v, of shape (...,
        2). Use it, for example, to start rays at nearest points or at vertices.

        >>> nearest = mesh.nearest((0.25, 0.5, 3))
        >>> mesh.surface(nearest.triangle, nearest.uv).leave((0, 0, 1)).shape
        (3,)
        """
        triangles, places = np.asarray(as_array("triangle", triangle), np.int32), as_vectors("uv", uv, 2)
        if bool((triangles >= len(self.faces)).any()) or triangles.shape != places.shape[:-1]:
            raise ValueError(f"each point needs u, v and the index of one of the {len(self.faces)} triangles")
        return Hits(np.zeros(triangles.shape, np.float32), triangles, places, None, self)

    @cached_property
    def open_edges(self) -> int:
        """Number of open edges: edges with an odd number of triangles, and edges of duplicate
        triangles with the same orientation. Corners at the same position count as one. Triangles
        that are not finite are ignored. 0 for a closed mesh, for which `contains` is exact."""
        return open_edges(self._own, self.faces)

    def contains(
        self, points: npt.ArrayLike, *, threads: Optional[int] = None, progress: Progress = None
    ) -> Bools:
        if not self.is_closed:
            what = f"the mesh has {self.open_edges} open edges, so that its inside is not well defined"
            warnings.warn(what, stacklevel=3)
        return super().contains(points, threads=threads, progress=progress)

    contains.__doc__ = _Rays.contains.__doc__

    @property
    def is_closed(self) -> bool:
        """True if the mesh has no open edges, so that it has a well-defined inside."""
        return self.open_edges == 0

    @cached_property
    def area(self) -> float:
        """Area of the surface, the sum over all triangles.

        >>> durer.Mesh([[0, 0, 0], [2, 0, 0], [0, 1, 0]], [[0, 1, 2]]).area
        1.0
        """
        return float(np.linalg.norm(self._crossed[1], axis=1).sum() / 2)

    @cached_property
    def volume(self) -> float:
        """Volume inside the mesh, which is negative if its triangles face inwards. It has a meaning
        only if `is_closed` is true.

        >>> corners = [[0, 0, 0], [6, 0, 0], [0, 1, 0], [0, 0, 1]]
        >>> durer.Mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).volume
        1.0
        """
        corner, crossed = self._crossed
        return float((corner * crossed).sum() / 6)

    @property
    def _crossed(self) -> tuple[Doubles, Doubles]:
        """First corners of the triangles, and cross products of the edges that begin there."""
        a, b, c = self._own.astype(np.float64)[self.faces].swapaxes(0, 1)
        return a, np.cross(b - a, c - a)

    @property
    def normals(self) -> Floats:
        """Unit normals of all triangles; 0 for triangles without area."""
        count = len(self.faces)
        all = (None, np.arange(count, dtype=np.int32), np.zeros((count, 2), np.float32))
        return _durer.hit_normals(self._tree, all, None).reshape(-1, 3)


Placed: TypeAlias = Union[Mesh, tuple[Mesh, npt.ArrayLike]]


@with_hints
class Scene(_Rays):
    __doc__ = (_Rays.__doc__ or "").replace(
        "Queries that meshes and scenes share.",
        """Scene of instanced meshes, ready for ray queries. A mesh used by several objects is
        stored once.

    `objects` are meshes, or pairs of a mesh and its matrix to world space, 4 x 4 or 3 x 4, which
    can be any invertible affine map. If several objects are hit at the same `t`, the one with the
    lowest index wins.

    >>> right = np.array([[1, 0, 0, 4], [0, 1, 0, 0], [0, 0, 1, 0]])
    >>> scene = durer.Scene([mesh, (mesh, right)])
    >>> scene.closest([(0, 0, 5), (4, 0, 5), (9, 0, 5)], (0, 0, -1)).object
    array([ 0,  1, -1], dtype=int32)
    """,
    )

    #: The mesh of each object.
    meshes: Sequence[Mesh]
    #: The matrix of each object to world space: shape (n, 3, 4).
    matrices: Doubles

    def __init__(self, objects: Iterable[Placed]) -> None:
        meshes, matrices = [], []
        for i, placed in enumerate(objects):
            mesh, place = placed if isinstance(placed, tuple) else (placed, np.eye(4))
            if not isinstance(mesh, Mesh):
                raise TypeError(f"object {i} must be a Mesh or a pair of a Mesh and a matrix, but is {type(mesh).__name__}")
            meshes.append(mesh)
            matrices.append(as_matrix(f"the matrix of object {i}", place))
        self.meshes = tuple(meshes)
        self.matrices = np.array(matrices, np.float64).reshape(-1, 3, 4)
        trees = [mesh._tree for mesh in self.meshes]
        self._tree = _durer.Tree.from_instances(trees, rows(self.matrices, 12))
        least, greatest = self._tree.bounds()
        size = max((b - a for a, b in zip(least, greatest)), default=0.0)
        self._far = bool(self.meshes) and max(map(abs, [*least, *greatest])) > FAR * size >= 0

    def move(self, places: Mapping[int, npt.ArrayLike]) -> Scene:
        """Returns the scene with new matrices for some objects, given by index. Meshes and their
        trees are shared with this scene; only the small tree over the objects is rebuilt."""
        for i in places:
            if not 0 <= i < len(self.meshes):
                raise ValueError(f"there is no object {i}: the scene has {len(self.meshes)} objects, numbered from 0")
        return Scene((mesh, places.get(i, self.matrices[i])) for i, mesh in enumerate(self.meshes))

    def __reduce__(self) -> Any:
        return Scene, (list(zip(self.meshes, self.matrices)),)

    def __repr__(self) -> str:
        return f"<Scene of {len(self.meshes)} objects>"

    @cached_property
    def _joined(self) -> tuple[Mesh, npt.NDArray[np.int64]]:
        """Returns all objects as one mesh, and the index of each object's first triangle."""
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
        mesh, starts = self._joined
        near = mesh.nearest(points, within, threads=threads, progress=progress)
        objects = np.where(near.triangle >= 0, np.searchsorted(starts, near.triangle, side="right") - 1, -1)
        triangle = np.where(near.triangle >= 0, near.triangle - starts[np.maximum(objects, 0)], -1).astype(np.int32)
        return Nearest(near.distance, near.point, triangle, objects.astype(np.int32), near.uv)

    nearest.__doc__ = (_Rays.nearest.__doc__ or "").replace(
        "`within`.", "`within`. The first such query joins all objects into one mesh."
    )


def split_rays(value: Any) -> tuple[Floats, Floats]:
    """Splits Open3D's rays of six numbers into origins and directions."""
    array = as_array("rays", value)
    if array.ndim == 0 or array.shape[-1] != 6:
        raise ValueError(f"rays must have the shape (..., 6), but has {array.shape}")
    array = np.asarray(array, np.float32)
    return array[..., :3], array[..., 3:]
