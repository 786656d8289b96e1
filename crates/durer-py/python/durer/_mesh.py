"""Vertices and edges of meshes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._arrays import Bools, Doubles, Floats, Places, finite

#: A mesh that is so many times its extent away is kept as it is seen from its own middle: five bits of the 24 of single precision.
FAR = 32


def _center(vertices: Places) -> Doubles:
    """The middle of the box around vertices, a number of single precision, along the axes along which it is far away; 0 along
    others. Single coordinates less such a middle are single again, exactly."""
    if not np.isfinite(vertices).all():
        vertices = vertices[finite(vertices)]
    if not len(vertices):
        return np.zeros(3)
    least, greatest = vertices.min(0).astype(np.float64), vertices.max(0).astype(np.float64)
    with np.errstate(over="ignore"):
        middle = (least / 2 + greatest / 2).astype(np.float32)
    is_far = np.isfinite(middle) & (np.abs(middle) > FAR * (greatest / 2 - least / 2).max() * 2)
    return np.where(is_far, middle, 0).astype(np.float64)


def centered(given: Places) -> tuple[Floats, Doubles]:
    """Vertices as they are seen from a middle, in single precision and a copy; and the middle."""
    center = _center(given)
    with np.errstate(over="ignore", invalid="ignore"):
        own = np.array(given - center if center.any() else given, np.float32, order="C")
    lost = np.isinf(own) & np.isfinite(given)
    if lost.any():
        i = int(lost.any(axis=1).argmax())
        raise ValueError(f"vertices[{i}] is {given[i].tolist()}, which is beyond single precision")
    return own, center


def _is_even(corners: npt.NDArray[np.int64]) -> Bools:
    """Whether the corners of triangles are in the order of their numbers, or turned from that."""
    a, b, c = corners.T
    is_even: Bools = (a < b) == ((b < c) == (a < c))
    return is_even


def open_edges(vertices: Floats, triangles: npt.NDArray[np.uint32]) -> int:
    """How many edges are open: see `Mesh.open_edges`."""
    is_finite = finite(vertices)
    _, place = np.unique(np.where(is_finite[:, None], vertices + np.float32(0), 0), axis=0, return_inverse=True)
    faces = triangles.astype(np.int64)
    corners = place.reshape(-1)[faces[is_finite[faces].all(axis=1)]]
    pairs = np.sort(np.stack([corners, np.roll(corners, -1, 1)], -1), -1)
    edges, first, times = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True, return_counts=True)
    is_open = times % 2 == 1
    # Of triangles with the same corners those to opposite sides are a sheet without thickness; what is left more than once.
    ways = np.where(_is_even(corners), 1, -1)
    _, which = np.unique(np.sort(corners, 1), axis=0, return_inverse=True)
    which = which.reshape(-1)
    several = np.abs(np.bincount(which, ways, minlength=1)) > 1.5
    is_open[first.reshape(-1, 3)[several[which]]] = True
    return int((is_open & (edges[:, 0] != edges[:, 1])).sum())
