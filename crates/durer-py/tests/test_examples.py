"""Tests that the examples run and match closed forms."""

import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import durer

EXAMPLES = Path(__file__).parents[1] / "examples"
sys.path.insert(0, str(EXAMPLES))


def of(name: str) -> dict:
    return runpy.run_path(str(EXAMPLES / f"{name}.py"))


@pytest.mark.parametrize(
    ("name", "small", "file"),
    [
        ("signed_distance", "12", "out.npz"),
        ("ambient_occlusion", "4", "out.ply"),
        ("xray", "24", "out.pgm"),
        ("lidar", "60", "out.ply"),
        ("depth_data", "2", "out"),
        ("shadow_hours", "16", "out.pgm"),
    ],
)
def test_each_example_runs_as_a_program(name, small, file, tmp_path):
    ran = subprocess.run(
        [sys.executable, EXAMPLES / f"{name}.py", small, file], cwd=tmp_path, capture_output=True, text=True
    )
    assert ran.returncode == 0, ran.stderr
    assert "wrote" in ran.stdout and (tmp_path / file).exists()


def test_every_example_is_tested():
    names = {path.stem for path in EXAMPLES.glob("*.py")} - {"shapes", "notebooks"}
    tried = {case[0] for case in test_each_example_runs_as_a_program.pytestmark[0].args[1]}
    assert names == tried


def test_distances_of_a_ball():
    shapes, example = of("shapes"), of("signed_distance")
    mesh = durer.Mesh(*shapes["ball"](1.0, 64))
    found, start, side = example["signed_distances"](mesh, 20)
    axis = [s + side * np.arange(21) for s in start]
    true = np.sqrt(sum(a**2 for a in np.meshgrid(*axis, indexing="ij"))) - 1
    # Facets lie inside the sphere by up to 1 - cos of half their angle.
    assert np.abs(found - true).max() < 0.002 and (np.sign(found) == np.sign(true)).mean() > 0.999


def test_a_floor_before_a_wall_sees_half_of_the_sky():
    shapes, example = of("shapes"), of("ambient_occlusion")
    ball = example["openness"](durer.Mesh(*shapes["ball"](1.0, 16)), 32)
    assert (ball == 1).all()
    # An infinite wall leaves (1 + cos a) / 2 of the cosine-weighted sky, where a is its elevation
    # angle. This wall is long.
    floor, wall = shapes["grid"](-1, 1, 0, 2, 2), shapes["box"]((-500, -1, -1), (500, 0, 500))
    seen = example["openness"](durer.Mesh(*shapes["together"](floor, wall)), 20_000)
    at = (floor[0][:, 0] == 0) & (floor[0][:, 1] == 1)
    high = np.arctan2(500, 1)
    assert np.abs(seen[: len(floor[0])][at] - (1 + np.cos(high)) / 2).max() < 0.01


def test_thickness_is_the_length_of_chords():
    shapes, example = of("shapes"), of("xray")
    shell, hollow = shapes["ball"](1.0, 96), shapes["ball"](0.5, 96)
    mesh = durer.Mesh(*shapes["together"](shell, (hollow[0], hollow[1][:, ::-1])))
    b = np.array([0, 0.2, 0.4, 0.6, 0.9, 1.1])
    origins = np.stack([b, 0 * b, 0 * b + 4], -1)
    chord = 2 * np.sqrt(np.maximum(1 - b**2, 0)) - 2 * np.sqrt(np.maximum(0.25 - b**2, 0))
    assert np.abs(example["thickness"](mesh, origins, [0, 0, -1]) - chord).max() < 0.005


def test_scan_points_lie_on_surfaces():
    shapes, example = of("shapes"), of("lidar")
    scene = durer.Scene([durer.Mesh(*shapes["grid"](-90, 90, -90, 90, 1)), durer.Mesh(*shapes["ball"](2, 48, (8, 0, 1)))])
    points, objects, power = example["scan"](scene, (0, 0, 1.5), steps=360)
    assert np.abs(points[objects == 0][:, 2]).max() < 1e-4
    off = np.linalg.norm(points[objects == 1] - (8, 0, 1), axis=1) - 2
    assert (objects == 1).sum() > 50 and np.abs(off).max() < 0.01 and (power > 0).all()
    # The ball hides a part of the floor, so no point lies in its shadow.
    assert np.linalg.norm(points, axis=1).max() <= 60.1


def test_depth_and_flow_belong_together():
    example = of("depth_data")
    one, again = example["sample"](5), example["sample"](5)
    assert all(np.array_equal(one[name], again[name], equal_nan=True) for name in one)
    v, u = np.nonzero(one["seen"])
    inner, outer, other = one["intrinsics"], one["extrinsics"], one["extrinsics_2"]
    local = one["depth"][v, u][:, None] * (np.linalg.inv(inner) @ np.stack([u, v, np.ones(len(u))])).T
    world = (local - outer[:, 3]) @ outer[:, :3]
    there = (world @ other[:, :3].T + other[:, 3]) @ inner.T
    moved = there[:, :2] / there[:, 2:] - np.stack([u, v], -1)
    assert len(u) > 5000 and np.abs(moved - one["flow"][v, u]).max() < 1e-3


def test_the_sun_shines_for_half_of_the_day_at_the_equinox():
    shapes, example = of("shapes"), of("shadow_hours")
    house = durer.Mesh(*shapes["box"]((-10, 0, 0), (10, 10, 20)))
    far, south, north = example["hours"](house, [(0, 5000, 0), (0, -0.01, 0), (0, 10.01, 0)], 45.0, 81)
    # South of the house, the house hides only the northern half of the sky, where the sun never is
    # at the equinox. North of it, little sun remains.
    assert abs(far - 12) < 0.4 and abs(south - far) < 0.7 and north < 0.5
    long, short = (example["hours"](house, (0, 5000, 0), 60.0, day) for day in (172, 355))
    assert abs(long - 18.5) < 0.4 and abs(short - 5.5) < 0.4
