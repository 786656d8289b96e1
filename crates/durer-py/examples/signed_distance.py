"""A grid of signed distances: the distance of each point from a surface, negative inside.

    python signed_distance.py [cells per side] [distances.npz]
"""

import sys

import numpy as np
from shapes import ball, box, together

import durer


def signed_distances(mesh: durer.Mesh, cells: int, margin: float = 0.1):
    """Returns signed distances at the corners of cubic cells around a closed mesh, the lower corner
    of the grid, and the cell size."""
    low, high = mesh.bounds.astype(float)
    side = (high - low).max() * (1 + 2 * margin) / cells
    start = (low + high) / 2 - side * cells / 2
    axis = side * np.arange(cells + 1)
    points = start + np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1)
    return mesh.distance(points, signed=True), start, side


def main(cells: int = 48, output: str = "distances.npz") -> None:
    mesh = durer.Mesh(*together(ball(1.0, 48), box((1.2, -0.5, -0.5), (2.0, 0.5, 0.5))))
    distances, start, side = signed_distances(mesh, cells)
    np.savez_compressed(output, distances=distances.astype("f4"), start=start, side=side)
    volume = (distances < 0).sum() * side**3
    print(f"{distances.size} distances; about {volume:.2f} of volume inside; wrote {output}")


if __name__ == "__main__":
    main(*(int(word) if word.isdigit() else word for word in sys.argv[1:]))
