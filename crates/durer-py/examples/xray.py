"""Thickness of a part, as X-rays measure it: the length of each ray inside the material.

    python xray.py [pixels per side] [xray.pgm]
"""

import sys

import numpy as np
from shapes import ball, save_pgm, together

import durer


def thickness(mesh: durer.Mesh, origins, directions) -> np.ndarray:
    """Returns the length of each ray inside a closed mesh, for unit directions. An inner surface
    with inverted triangles encloses a hollow."""
    hits = mesh.all_hits(origins, directions)
    # The length inside is the sum of the exit distances minus the sum of the entry distances.
    towards = np.broadcast_to(directions, (*hits.count.shape, 3)).reshape(-1, 3)[hits.ray]
    leaving = np.sign((mesh.normals[hits.triangle] * towards).sum(axis=1))
    return np.bincount(hits.ray, leaving * hits.t, hits.count.size).reshape(hits.count.shape)


def main(side: int = 200, output: str = "xray.pgm") -> None:
    shell, hollow, core = ball(1.0, 64), ball(0.8, 64), ball(0.3, 32, (0.2, 0.1, 0))
    mesh = durer.Mesh(*together(shell, (hollow[0], hollow[1][:, ::-1]), core))
    x, y = np.meshgrid(np.linspace(-1.2, 1.2, side), np.linspace(1.2, -1.2, side))
    origins = np.stack([x, y, np.full(x.shape, 5.0)], -1)
    length = thickness(mesh, origins, [0, 0, -1.0])
    # The Beer-Lambert law gives the light that remains.
    save_pgm(output, 1 - np.exp(-1.2 * length))
    print(f"{side} x {side} rays; the longest way inside is {length.max():.3f}; wrote {output}")


if __name__ == "__main__":
    main(*(int(word) if word.isdigit() else word for word in sys.argv[1:]))
