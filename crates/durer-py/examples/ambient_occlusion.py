"""Ambient occlusion, baked into the vertices of a mesh: the fraction of the sky that each vertex
sees.

    python ambient_occlusion.py [rays for a vertex] [baked.ply]
"""

import sys

import numpy as np
from shapes import ball, box, grid, save_ply, together

import durer


def directions_about(normals: np.ndarray, count: int, seed: int = 1) -> np.ndarray:
    """Returns `count` cosine-distributed directions around each normal: shape (n, count, 3)."""
    u, v = np.random.default_rng(seed).uniform(size=(2, len(normals), count))
    z, r, turn = np.sqrt(1 - u), np.sqrt(u), 2 * np.pi * v
    other = np.where(np.abs(normals[:, :1]) < 0.7, [[1.0, 0, 0]], [[0, 1.0, 0]])
    right = np.cross(other, normals)
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    up = np.cross(normals, right)
    frame = [axis[:, None, :] for axis in (right, up, normals)]
    return (r * np.cos(turn))[..., None] * frame[0] + (r * np.sin(turn))[..., None] * frame[1] + z[..., None] * frame[2]


def openness(mesh: durer.Mesh, count: int) -> np.ndarray:
    """Returns the cosine-weighted fraction of the sky that each vertex sees: 1 if nothing occludes
    it. Each triangle around a vertex samples its own hemisphere, and the results are weighted by
    area."""
    triangles = np.repeat(np.arange(len(mesh.faces)), 3)
    corners = mesh.surface(triangles, np.tile([[0, 0], [1, 0], [0, 1]], (len(mesh.faces), 1)))
    ways = directions_about(corners.normal, -(-count // 6))
    seen = 1 - mesh.occluded(corners[:, None].leave(ways), ways).mean(axis=1)
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(float) for i in range(3))
    area = np.repeat(np.linalg.norm(np.cross(b - a, c - a), axis=1), 3)
    at, vertices = mesh.faces.reshape(-1), len(mesh.vertices)
    return np.bincount(at, area * seen, vertices) / np.maximum(np.bincount(at, area, vertices), 1e-300)


def main(count: int = 64, output: str = "baked.ply") -> None:
    mesh = durer.Mesh(*together(grid(-3, 3, -3, 3, 60), ball(1.0, 24, (0, 0, 1.0)), box((1.2, -1, 0), (2.2, 1, 1.5))))
    seen = openness(mesh, count)
    save_ply(output, mesh.vertices, mesh.faces, seen)
    print(f"{len(seen)} vertices, {count} rays each; the mean sees {100 * seen.mean():.1f} % of the sky; wrote {output}")


if __name__ == "__main__":
    main(*(int(word) if word.isdigit() else word for word in sys.argv[1:]))
