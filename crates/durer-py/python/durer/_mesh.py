"""Centring of vertices far from the origin, and open edges of meshes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._arrays import Bools, Doubles, Floats, Points, finite

#: Distance from the origin, as a multiple of the mesh's extent, beyond which vertices are stored
#: relative to the mesh's centre. At this distance, five of the 24 bits of single precision are
#: lost.
FAR = 32


def _center(vertices: Points) -> Doubles:
    """Returns the centre of the vertices' bounds along the axes along which it is far away, and 0
    along the others. The centre is rounded to single precision, so subtracting it from
    single-precision coordinates is exact."""
    if not np.isfinite(vertices).all():
        vertices = vertices[finite(vertices)]
    if not len(vertices):
        return np.zeros(3)
    least, greatest = vertices.min(0).astype(np.float64), vertices.max(0).astype(np.float64)
    with np.errstate(over="ignore"):
        middle = (least / 2 + greatest / 2).astype(np.float32)
    is_far = np.isfinite(middle) & (np.abs(middle) > FAR * (greatest / 2 - least / 2).max() * 2)
    return np.where(is_far, middle, 0).astype(np.float64)


def centered(given: Points) -> tuple[Floats, Doubles]:
    """Returns a single-precision copy of the vertices relative to a centre, and the centre."""
    center = _center(given)
    with np.errstate(over="ignore", invalid="ignore"):
        own = np.array(given - center if center.any() else given, np.float32, order="C")
    lost = np.isinf(own) & np.isfinite(given)
    if lost.any():
        i = int(lost.any(axis=1).argmax())
        raise ValueError(f"vertices[{i}] is {given[i].tolist()}, which exceeds the range of single precision")
    return own, center


def _is_even(corners: npt.NDArray[np.int64]) -> Bools:
    """Returns a mask of the triangles whose corner indices are a rotation of ascending order."""
    a, b, c = corners.T
    is_even: Bools = (a < b) == ((b < c) == (a < c))
    return is_even


def open_edges(vertices: Floats, triangles: npt.NDArray[np.uint32]) -> int:
    """Returns the number of open edges, as defined by `Mesh.open_edges`."""
    is_finite = finite(vertices)
    _, place = np.unique(np.where(is_finite[:, None], vertices + np.float32(0), 0), axis=0, return_inverse=True)
    faces = triangles.astype(np.int64)
    corners = place.reshape(-1)[faces[is_finite[faces].all(axis=1)]]
    pairs = np.sort(np.stack([corners, np.roll(corners, -1, 1)], -1), -1)
    edges, first, times = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True, return_counts=True)
    is_open = times % 2 == 1
    # Two triangles with the same corners and opposite orientation form a closed sheet without
    # thickness. If one orientation occurs more often, its edges are open.
    ways = np.where(_is_even(corners), 1, -1)
    _, which = np.unique(np.sort(corners, 1), axis=0, return_inverse=True)
    which = which.reshape(-1)
    several = np.abs(np.bincount(which, ways, minlength=1)) > 1.5
    is_open[first.reshape(-1, 3)[several[which]]] = True
    return int((is_open & (edges[:, 0] != edges[:, 1])).sum())
