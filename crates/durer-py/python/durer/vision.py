"""Cameras in OpenCV's convention, which render depth, normals, instance masks and optical flow."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Union

import numpy as np
import numpy.typing as npt

from ._arrays import Bools, Doubles, Floats, Ints, Points, as_array
from .rays import Mesh, Scene


@dataclass(frozen=True, eq=False)
class View:
    """Images of a camera's view: depth, normals, objects and points per pixel, of shape (height,
    width) or (height, width, 3)."""

    #: Depth: z in the camera's frame, in scene units; infinite for misses.
    depth: Floats
    #: Distance along the pixel's ray, in scene units; infinite for misses.
    distance: Floats
    #: Surface normal in the camera's frame, towards the camera; 0 for misses.
    normals: Floats
    #: Index of the object, -1 for misses; instance masks are `instances == i`.
    instances: Ints
    #: Index of the triangle, -1 for misses.
    triangles: Ints
    #: Point in world space; NaN for misses.
    points: Points


def _zeros() -> Doubles:
    return np.zeros(5)


@dataclass(frozen=True, eq=False)
class Camera:
    """Camera in OpenCV's convention: x points right, y down and z forwards, and the centre of the
    first pixel is (0, 0).

    A world point X is R X + t in the camera's frame, where `extrinsics` = [R | t] is 3 x 4 or 4 x
    4. x / z and y / z are distorted by k1, k2, p1, p2[, k3[, k4, k5, k6]], as returned by
    `cv2.calibrateCamera`, and mapped to pixels by the 3 x 3 matrix `intrinsics`.
    """

    intrinsics: npt.ArrayLike
    extrinsics: npt.ArrayLike
    width: int
    height: int
    distortion: npt.ArrayLike = field(default_factory=_zeros)

    def __post_init__(self) -> None:
        for name, size in (("width", self.width), ("height", self.height)):
            if not isinstance(size, (int, np.integer)) or size < 1:
                raise ValueError(f"{name} must be a whole number of pixels, 1 or more, but is {size!r}")
        self._inner()
        self._outer()
        self._coefficients()

    def _inner(self) -> Doubles:
        inner = np.asarray(as_array("intrinsics", self.intrinsics), np.float64)
        if inner.shape != (3, 3):
            raise ValueError(f"intrinsics must have the shape (3, 3), but has {inner.shape}")
        if not np.isfinite(inner).all() or (inner[2] != (0, 0, 1)).any() or inner[1, 0] != 0:
            raise ValueError(f"intrinsics must have the rows fx s cx, 0 fy cy, 0 0 1, but is {inner.tolist()}")
        if inner[0, 0] <= 0 or inner[1, 1] <= 0:
            raise ValueError(f"focal lengths must be more than 0, but are {inner[0, 0]:g} and {inner[1, 1]:g}")
        return inner

    def _outer(self) -> tuple[Doubles, Doubles]:
        outer = np.asarray(as_array("extrinsics", self.extrinsics), np.float64)
        if outer.shape not in ((3, 4), (4, 4)):
            raise ValueError(f"extrinsics must have the shape (3, 4) or (4, 4), but has {outer.shape}")
        if not np.isfinite(outer).all() or len(outer) == 4 and (outer[3] != (0, 0, 0, 1)).any():
            raise ValueError(f"extrinsics must be finite, with the last row 0 0 0 1 if there are four, but is {outer.tolist()}")
        turn = outer[:3, :3]
        if not np.allclose(turn @ turn.T, np.eye(3), atol=1e-5) or np.linalg.det(turn) < 0:
            raise ValueError("the left part of extrinsics must be a rotation")
        return turn, outer[:3, 3]

    def _coefficients(self) -> Doubles:
        given = np.asarray(as_array("distortion", self.distortion), np.float64).reshape(-1)
        if len(given) not in (0, 4, 5, 8):
            raise ValueError(f"distortion must have 4, 5 or 8 numbers, but has {len(given)}")
        if not np.isfinite(given).all():
            raise ValueError(f"distortion must be finite, but is {given.tolist()}")
        return np.concatenate([given, np.zeros(8 - len(given))])

    def _distorted(self, x: Doubles, y: Doubles) -> tuple[Doubles, Doubles]:
        k1, k2, p1, p2, k3, k4, k5, k6 = self._coefficients()
        r2 = x * x + y * y
        radial = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)))
        return (
            x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
        )

    def project(self, points: npt.ArrayLike) -> Doubles:
        """Returns the pixel coordinates x and y of world points of shape (..., 3); NaN for points
        behind the camera."""
        turn, shift = self._outer()
        local = np.asarray(as_array("points", points), np.float64) @ turn.T + shift
        with np.errstate(divide="ignore", invalid="ignore"):
            z = np.where(local[..., 2] > 0, local[..., 2], np.nan)
            x, y = self._distorted(local[..., 0] / z, local[..., 1] / z)
        inner = self._inner()
        return np.stack([inner[0, 0] * x + inner[0, 1] * y + inner[0, 2], inner[1, 1] * y + inner[1, 2]], -1)

    def rays(self) -> tuple[Doubles, Doubles]:
        """Returns the camera's position, and the direction of each pixel's ray in world space, of
        shape (height, width, 3). Directions have z = 1 in the camera's frame, so `t` is the depth.
        They are NaN where the distortion cannot be inverted."""
        inner, (turn, shift) = self._inner(), self._outer()
        u, v = np.meshgrid(np.arange(self.width, dtype=np.float64), np.arange(self.height, dtype=np.float64))
        yd = (v - inner[1, 2]) / inner[1, 1]
        xd = (u - inner[0, 2] - inner[0, 1] * yd) / inner[0, 0]
        x, y = xd.copy(), yd.copy()
        if self._coefficients().any():
            x, y = self._undistorted(xd, yd)
        local = np.stack([x, y, np.ones_like(x)], -1)
        return -turn.T @ shift, local @ turn

    def _undistorted(self, xd: Doubles, yd: Doubles) -> tuple[Doubles, Doubles]:
        """Inverts the distortion by Newton's method with finite differences."""
        x, y, step = xd.copy(), yd.copy(), 1e-6
        with np.errstate(all="ignore"):
            for _ in range(30):
                (fx, fy), (ax, ay), (bx, by) = (
                    self._distorted(x, y), self._distorted(x + step, y), self._distorted(x, y + step),
                )  # fmt: skip
                a, b, c, d = (ax - fx) / step, (bx - fx) / step, (ay - fy) / step, (by - fy) / step
                ex, ey, det = fx - xd, fy - yd, a * d - b * c
                x, y = x - (d * ex - b * ey) / det, y - (a * ey - c * ex) / det
            fx, fy = self._distorted(x, y)
            good = np.hypot(fx - xd, fy - yd) < 1e-9
        return np.where(good, x, np.nan), np.where(good, y, np.nan)

    def view(self, scene: Union[Mesh, Scene]) -> View:
        """Traces a ray through each pixel, and returns what it hits."""
        eye, ways = self.rays()
        hits = scene.closest(eye, ways)
        length = np.linalg.norm(ways, axis=-1)
        normals = hits.normal @ self._outer()[0].T
        away = (hits.normal * ways).sum(-1, keepdims=True) > 0
        facing: Floats = np.where(away, -normals, normals).astype(np.float32)
        with np.errstate(invalid="ignore"):
            distance: Floats = np.where(hits.hit, hits.t * length, np.inf).astype(np.float32)
        return View(hits.t, distance, facing, hits.object, hits.triangle, hits.point)

    def flow(self, scene: Union[Mesh, Scene], other: Camera) -> tuple[Doubles, Bools]:
        """Returns the optical flow to another camera in a static scene, that is, the motion of each
        pixel, of shape (height, width, 2), NaN for misses. Also returns True for each point that is
        inside the other camera's image and not occluded there."""
        hits = scene.closest(*self.rays())
        points = hits.point.astype(np.float64)
        there = other.project(points)
        u, v = np.meshgrid(np.arange(self.width), np.arange(self.height))
        eye = other.rays()[0]
        with np.errstate(invalid="ignore"):
            inside = (there >= -0.5).all(-1) & (there[..., 0] < other.width - 0.5) & (there[..., 1] < other.height - 0.5)
            starts = hits.leave(eye - points)
            hidden = scene.occluded(starts, eye - starts, t_max=1)
        return there - np.stack([u, v], -1), inside & ~hidden
