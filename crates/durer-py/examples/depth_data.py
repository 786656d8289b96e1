"""A training set: depth, normals, instances and optical flow of random scenes from random cameras,
with ground truth.

    python depth_data.py [examples] [folder]
"""

import sys
from pathlib import Path

import numpy as np
from shapes import ball, box, grid

import durer
from durer.vision import Camera

WIDTH, HEIGHT, FOCAL = 160, 120, 150.0


def some_scene(rng: np.random.Generator) -> durer.Scene:
    """Returns a random scene: a floor with balls and boxes that are rotated about z."""
    shapes = [durer.Mesh(*ball(1, 24)), durer.Mesh(*box((-1, -1, -1), (1, 1, 1)))]
    objects: list = [durer.Mesh(*grid(-12, 12, -12, 12, 1))]
    for _ in range(rng.integers(4, 9)):
        size, turn, (x, y) = rng.uniform(0.3, 1.2), rng.uniform(0, 2 * np.pi), rng.uniform(-4, 4, 2)
        c, s = size * np.cos(turn), size * np.sin(turn)
        objects.append((shapes[rng.integers(2)], [[c, -s, 0, x], [s, c, 0, y], [0, 0, size, size]]))
    return durer.Scene(objects)


def camera_at(eye: np.ndarray, target: np.ndarray) -> Camera:
    """Returns an OpenCV camera at `eye` that looks at a point; z is up in the world."""
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, (0, 0, 1))
    right /= np.linalg.norm(right)
    turn = np.stack([right, np.cross(forward, right), forward])
    inner = [[FOCAL, 0, (WIDTH - 1) / 2], [0, FOCAL, (HEIGHT - 1) / 2], [0, 0, 1]]
    return Camera(inner, np.column_stack([turn, -turn @ eye]), WIDTH, HEIGHT)


def sample(seed: int) -> dict[str, np.ndarray]:
    """Returns one example, determined by the seed: two poses and their ground truth."""
    rng = np.random.default_rng(seed)
    scene = some_scene(rng)
    angle, far, high = rng.uniform(0, 2 * np.pi), rng.uniform(5, 10), rng.uniform(1.5, 5)
    eye, target = np.array([far * np.cos(angle), far * np.sin(angle), high]), np.array([*rng.uniform(-1, 1, 2), 0.5])
    first, second = camera_at(eye, target), camera_at(eye + rng.normal(scale=0.15, size=3), target)
    view = first.view(scene)
    flow, seen = first.flow(scene, second)
    return {
        "depth": view.depth, "normals": view.normals, "instances": view.instances.astype(np.int16),
        "flow": flow.astype(np.float32), "seen": seen, "intrinsics": np.asarray(first.intrinsics),
        "extrinsics": np.asarray(first.extrinsics), "extrinsics_2": np.asarray(second.extrinsics),
    }  # fmt: skip


def main(count: int = 20, folder: str = "depth_data") -> None:
    Path(folder).mkdir(exist_ok=True)
    for seed in range(count):
        np.savez_compressed(Path(folder) / f"{seed:05}.npz", **sample(seed))
    print(f"wrote {count} examples of {WIDTH} x {HEIGHT} pixels into {folder}")


if __name__ == "__main__":
    main(*(int(word) if word.isdigit() else word for word in sys.argv[1:]))
