"""Drop-in replacement for `embreex`: `EmbreeDevice`, `EmbreeScene`, `TriangleMesh`, `ElementMesh`,
`scene.run`. Unlike embreex's, the normals `Ng` have unit length."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from .rays import Mesh, Scene, _Rays


class EmbreeDevice:
    """Placeholder for embreex's device; does nothing."""


class EmbreeScene:
    """Scene to which `TriangleMesh` and `ElementMesh` add meshes. The first query builds its tree.
    `device` and `robust` are ignored."""

    def __init__(self, device: Optional[EmbreeDevice] = None, robust: bool = False) -> None:
        self.meshes: list[Mesh] = []
        self._built: Optional[_Rays] = None

    def run(
        self,
        vec_origins: npt.ArrayLike,
        vec_directions: npt.ArrayLike,
        dists: Optional[npt.ArrayLike] = None,
        query: str = "INTERSECT",
        output: Any = None,
    ) -> Any:
        """Runs a query. `INTERSECT` returns the triangle that each ray hits, or -1; `OCCLUDED`
        returns 0 for a hit and -1 for a miss; `DISTANCE` returns the distance, or the end of the
        ray for a miss. `dists` sets the ends of the rays, 1e37 by default. If `output` is set, the
        result is a dictionary of all attributes, with zeros for misses."""
        if self._built is None:
            self._built = self.meshes[0] if len(self.meshes) == 1 else Scene(self.meshes)
        far: npt.ArrayLike = np.float32(1e37) if dists is None else dists
        if query not in ("INTERSECT", "OCCLUDED", "DISTANCE"):
            raise ValueError(f"Embree ray query type {query} not recognized.\nAccepted types are (INTERSECT,OCCLUDED,DISTANCE)")
        if query == "OCCLUDED":
            return np.where(self._built.occluded(vec_origins, vec_directions, t_max=far), 0, -1).astype(np.int32)
        hits = self._built.closest(vec_origins, vec_directions, t_max=far)
        distance = np.where(hits.hit, hits.t, np.asarray(far, np.float32))
        if output:
            uv, normal = (np.where(hits.hit[..., None], values, np.float32(0)) for values in (hits.uv, hits.normal))
            u, v = uv[..., 0], uv[..., 1]
            return {"u": u, "v": v, "Ng": normal, "tfar": distance, "primID": hits.triangle, "geomID": hits.object}
        return hits.triangle if query == "INTERSECT" else distance


class TriangleMesh:
    """Adds a mesh to a scene: vertices and triangles, or triangle corners of shape (n, 3, 3)."""

    def __init__(self, scene: EmbreeScene, vertices: npt.ArrayLike, indices: Optional[npt.ArrayLike] = None) -> None:
        places = np.asarray(vertices)
        faces = np.arange(3 * len(places)).reshape(-1, 3) if indices is None else np.asarray(indices)
        scene.meshes.append(Mesh(places.reshape(-1, 3), faces))
        scene._built = None


# Faces of finite elements as triangles, counterclockwise from outside; a face of a hexahedron is
# two triangles. Corners of hexahedra are numbered as in T. Tautges, "Canonical numbering systems
# for finite-element codes", 2010.
_TETRAHEDRON = ((0, 1, 3), (2, 3, 1), (0, 3, 2), (0, 2, 1))
_HEXAHEDRON = (
    (0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4),
    (1, 2, 6), (1, 6, 5), (0, 7, 3), (0, 4, 7), (3, 6, 2), (3, 7, 6),
)  # fmt: skip


class ElementMesh:
    """Adds the faces of tetrahedra (indices of shape (n, 4)) or hexahedra ((n, 8)) to a scene: 4
    or 12 triangles each."""

    def __init__(self, scene: EmbreeScene, vertices: npt.ArrayLike, indices: npt.ArrayLike) -> None:
        elements = np.asarray(indices)
        corners = elements.shape[1] if elements.ndim == 2 else 0
        if corners not in (4, 8):
            raise NotImplementedError(f"elements have 4 or 8 corners, but the indices have the shape {elements.shape}")
        faces = elements[:, np.array(_TETRAHEDRON if corners == 4 else _HEXAHEDRON)]
        TriangleMesh(scene, vertices, faces.reshape(-1, 3))
