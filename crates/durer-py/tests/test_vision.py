"""Tests of the vision cameras against OpenCV's formulas."""

import numpy as np
import pytest
from test_rays import CUBE, CUBE_FACES, sphere

import durer
from durer.vision import Camera

K = np.array([[60.0, 0, 31.5], [0, 62.0, 23.5], [0, 0, 1]])
LENS = [-0.2, 0.05, 0.001, -0.002, 0.01]


def pose(degrees, shift):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.column_stack([[[c, 0, s], [0, 1, 0], [-s, 0, c]], shift])


def test_rays_and_projection_are_inverse():
    for lens in ([], LENS, [0.1, 0, 0, 0, 0, 0.05, 0, 0]):
        camera = Camera(K, pose(20, [0.1, -0.2, 5]), 64, 48, lens)
        eye, ways = camera.rays()
        u, v = np.meshgrid(np.arange(64), np.arange(48))
        assert np.allclose(camera.project(eye + 3 * ways), np.stack([u, v], -1), atol=1e-6)


def test_depth_normals_and_masks_are_those_of_a_wall_and_a_ball():
    wall = durer.Mesh([[-50, -50, 4], [50, -50, 4], [50, 50, 4], [-50, 50, 4]], [[0, 1, 2], [0, 2, 3]])
    ball = durer.Mesh(*sphere(48))
    scene = durer.Scene([wall, (ball, np.diag([0.5, 0.5, 0.5, 1.0]) + [[0, 0, 0, 0], [0] * 4, [0, 0, 0, 2], [0] * 4])])
    view = Camera(K, np.eye(4), 64, 48).view(scene)
    assert set(np.unique(view.instances)) == {0, 1}
    there = view.instances == 0
    assert np.allclose(view.depth[there], 4, atol=1e-5) and np.allclose(view.normals[there], [0, 0, -1])
    assert view.depth[24, 32] == pytest.approx(1.5, abs=5e-3) and view.instances[24, 32] == 1
    assert np.allclose(np.linalg.norm(view.points, axis=-1), view.distance, rtol=1e-5)


def test_flow_of_a_turned_camera_is_its_projection():
    scene = durer.Mesh(CUBE * 2 - 1, CUBE_FACES)
    first, second = Camera(K, pose(0, [0, 0, 4]), 64, 48), Camera(K, pose(5, [0.1, 0, 4]), 64, 48, LENS)
    flow, seen = first.flow(scene, second)
    view = first.view(scene)
    assert np.isnan(flow[view.instances < 0]).all() and seen.any() and not seen[view.instances < 0].any()
    y, x = 24, 30
    assert np.allclose(flow[y, x] + [x, y], second.project(view.points[y, x]))
    # For a point that both cameras see, its depth is that in the second image.
    there = np.round(flow[y, x] + [x, y]).astype(int)
    turn, shift = second._outer()
    assert seen[y, x] and (turn @ view.points[y, x] + shift)[2] == pytest.approx(second.view(scene).depth[there[1], there[0]], rel=0.02)


def test_invalid_cameras_are_refused():
    skew, nan = K.copy(), K.copy()
    skew[2, 0], nan[0, 2] = 1, np.nan
    for wrong, said in [
        ((np.eye(4), np.eye(4), 8, 8), r"intrinsics must have the shape \(3, 3\)"),
        ((K, np.eye(3), 8, 8), r"extrinsics must have the shape \(3, 4\)"),
        ((K, 2 * np.eye(4), 8, 8), "the last row 0 0 0 1"),
        ((K, 2 * np.eye(4)[:3], 8, 8), "must be a rotation"),
        ((K, np.eye(4), 8, 8, [1, 2, 3]), "4, 5 or 8 numbers"),
        ((K, np.eye(4), 8, 8, [0, 0, np.inf, 0]), "distortion must be finite"),
        ((skew, np.eye(4), 8, 8), "intrinsics must have the rows fx s cx, 0 fy cy, 0 0 1"),
        ((nan, np.eye(4), 8, 8), "intrinsics must have the rows fx s cx"),
        ((np.diag([0, 1, 1]), np.eye(4), 8, 8), "focal lengths must be more than 0"),
        ((K, np.eye(4), 8, 0), "height must be a whole number of pixels"),
        ((K, np.eye(4), 8.5, 8), "width must be a whole number of pixels"),
    ]:
        with pytest.raises(ValueError, match=said):
            Camera(*wrong)
