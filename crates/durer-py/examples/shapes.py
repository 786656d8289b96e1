"""Helpers for the examples: meshes as vertices and faces (counterclockwise from outside), and file
formats."""

import struct
import zlib

import numpy as np


def ball(radius: float = 1.0, cuts: int = 32, center=(0.0, 0.0, 0.0)):
    """Returns a sphere with `cuts` rows of triangles from pole to pole."""
    t, p = np.meshgrid(np.linspace(0, np.pi, cuts + 1)[1:-1], np.arange(2 * cuts) * np.pi / cuts, indexing="ij")
    ring = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], -1).reshape(-1, 3)
    vertices = np.concatenate([ring, [[0, 0, 1], [0, 0, -1]]])
    n, i = 2 * cuts, np.arange(2 * cuts)
    j, last = (i + 1) % n, (cuts - 2) * n
    faces = [np.stack([np.full(n, len(ring)), i, j], 1), np.stack([np.full(n, len(ring) + 1), j + last, i + last], 1)]
    for row in range(cuts - 2):
        a, b = row * n, (row + 1) * n
        faces += [np.stack([a + i, b + i, b + j], 1), np.stack([a + i, b + j, a + j], 1)]
    return radius * vertices + np.asarray(center), np.concatenate(faces)


def box(low, high):
    """Returns an axis-aligned box."""
    vertices = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * (np.subtract(high, low)) + low
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return vertices, np.array([corners for a, b, c, d in sides for corners in ((a, b, c), (a, c, d))])


def together(*meshes):
    """Joins several meshes into one."""
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    faces = [faces + start for (_, faces), start in zip(meshes, starts)]
    return np.concatenate([vertices for vertices, _ in meshes]), np.concatenate(faces)


def grid(x0: float, x1: float, y0: float, y1: float, cuts: int, z: float = 0.0):
    """Returns a horizontal grid of `cuts` x `cuts` cells that faces up."""
    x, y = np.meshgrid(np.linspace(x0, x1, cuts + 1), np.linspace(y0, y1, cuts + 1), indexing="ij")
    i = (np.arange(cuts)[:, None] * (cuts + 1) + np.arange(cuts)).reshape(-1)
    up, right = 1, cuts + 1
    faces = np.concatenate([np.stack([i, i + right, i + right + up], 1), np.stack([i, i + right + up, i + up], 1)])
    return np.stack([x.ravel(), y.ravel(), np.full(x.size, z)], 1), faces


def save_ply(path, vertices, faces, gray) -> None:
    """Writes a mesh with a grey value from 0 to 1 for each vertex."""
    with open(path, "w") as file:
        file.write(f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\n")
        file.write("".join(f"property float {axis}\n" for axis in "xyz"))
        file.write("".join(f"property uchar {color}\n" for color in ("red", "green", "blue")))
        file.write(f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
        shades = np.round(255 * np.clip(gray, 0, 1)).astype(int)
        file.writelines(f"{x:.9g} {y:.9g} {z:.9g} {s} {s} {s}\n" for (x, y, z), s in zip(vertices, shades))
        file.writelines(f"3 {a} {b} {c}\n" for a, b, c in faces)


def save_pgm(path, gray) -> None:
    """Writes a greyscale image with values from 0 to 1."""
    shades = np.round(255 * np.clip(gray, 0, 1)).astype(np.uint8)
    with open(path, "wb") as file:
        file.write(f"P5 {shades.shape[1]} {shades.shape[0]} 255\n".encode() + shades.tobytes())


class Picture:
    """Greyscale image with values from 0 to 1 that a notebook displays, as an 8-bit PNG file
    (ISO/IEC 15948)."""

    def __init__(self, gray, zoom: int = 1) -> None:
        self.gray = np.kron(np.round(255 * np.clip(np.nan_to_num(gray), 0, 1)).astype(np.uint8), np.ones((zoom, zoom), np.uint8))

    def _repr_png_(self) -> bytes:
        def chunk(kind: bytes, data: bytes) -> bytes:
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        height, width = self.gray.shape
        rows = b"".join(b"\0" + row.tobytes() for row in self.gray)
        head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
        return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
