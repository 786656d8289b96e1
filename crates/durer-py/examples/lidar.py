"""A lidar scan: the points measured by a rotating sensor with rows of beams.

    python lidar.py [steps per turn] [scan.ply]
"""

import sys

import numpy as np
from shapes import ball, box, grid

import durer


def scan(scene: durer.Scene, place, rows: int = 32, steps: int = 900, reach: float = 60.0, noise: float = 0.0, seed: int = 1):
    """Returns points, object indices and intensities of all beams that hit something within reach.

    Beams range from 25 degrees below the horizon to 15 above it; z is up. `noise` is the standard
    deviation of the measured distance. The intensity from a rough surface falls with the cosine and
    with the square of the distance.
    """
    height = np.radians(np.linspace(-25, 15, rows))[:, None]
    turn = 2 * np.pi * np.arange(steps) / steps
    flat = np.cos(height)
    beams = np.stack(np.broadcast_arrays(flat * np.cos(turn), flat * np.sin(turn), np.sin(height)), -1)
    hits = scene.closest(place, beams, t_max=reach)
    met, ranges = hits.hit, hits.t[hits.hit].astype(float)
    cosine = np.abs((hits.normal * beams).sum(-1))[met]
    ranges += noise * np.random.default_rng(seed).normal(size=ranges.shape)
    return np.asarray(place) + ranges[:, None] * beams[met], hits.object[met], cosine / ranges**2


def main(steps: int = 900, output: str = "scan.ply") -> None:
    parked = durer.Mesh(*box((-2.2, -0.9, 0.2), (2.2, 0.9, 1.5)))
    tree = durer.Mesh(*ball(1.5, 24, (0, 0, 3.5)))
    house = durer.Mesh(*box((-6, -4, 0), (6, 4, 7)))

    def at(x: float, y: float) -> np.ndarray:
        return np.array([[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, 0]])

    road = durer.Mesh(*grid(-80, 80, -80, 80, 2))
    scene = durer.Scene([road, (parked, at(6, 3)), (parked, at(-7, 3)), (tree, at(4, -8)), (house, at(12, 18)), (house, at(-14, 16))])
    points, objects, power = scan(scene, (0, 0, 1.8), steps=steps, noise=0.02)
    with open(output, "w") as file:
        file.write(f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n")
        file.write("".join(f"property float {name}\n" for name in ("x", "y", "z", "intensity")) + "property int object\nend_header\n")
        file.writelines(f"{x:.4f} {y:.4f} {z:.4f} {p:.6g} {o}\n" for (x, y, z), p, o in zip(points, power, objects))
    print(f"{len(points)} of {32 * steps} beams came back; wrote {output}")


if __name__ == "__main__":
    main(*(int(word) if word.isdigit() else word for word in sys.argv[1:]))
