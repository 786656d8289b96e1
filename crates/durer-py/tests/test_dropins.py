"""Tests of the drop-in classes against closed forms and, if installed, the original packages."""

import numpy as np
import pytest
from test_rays import CUBE, CUBE_FACES, directions, sphere

import durer
import durer.embreex
import durer.open3d
import durer.trimesh


def test_open3d_calls_answer():
    scene = durer.open3d.RaycastingScene()
    assert scene.add_triangles(CUBE, CUBE_FACES) == 0
    assert scene.add_triangles(CUBE + np.float32([3, 0, 0]), CUBE_FACES) == 1
    rays = np.array([[-1, 0.5, 0.25, 1, 0, 0], [2, 0.5, 0.25, 1, 0, 0], [0, 9, 0, 0, 1, 0]], np.float32)
    hit = scene.cast_rays(rays)
    assert hit["t_hit"].tolist() == [1, 1, np.inf]
    assert hit["geometry_ids"].tolist() == [0, 1, scene.INVALID_ID]
    assert scene.count_intersections(rays).tolist() == [4, 2, 0]
    assert scene.test_occlusions(rays, tfar=0.5).tolist() == [False] * 3
    listed = scene.list_intersections(rays)
    assert listed["ray_splits"].tolist() == [0, 4, 6, 6] and listed["t_hit"].tolist() == [1, 2, 4, 5, 1, 2]
    points = np.array([[0.5, 0.5, 0.5], [2, 0.5, 0.5], [3.5, 0.5, 0.75]], np.float32)
    assert scene.compute_signed_distance(points).tolist() == [-0.5, 1, -0.25]
    assert scene.compute_occupancy(points).tolist() == [1, 0, 1]
    # As in Open3D, a point in two meshes is outside.
    twice = durer.open3d.RaycastingScene()
    for shift in (0, 0.5):
        twice.add_triangles(CUBE + np.float32(shift), CUBE_FACES)
    assert twice.compute_occupancy([[0.25] * 3, [0.75] * 3, [1.25] * 3]).tolist() == [1, 0, 1]
    assert twice.compute_signed_distance(np.float32([[0.25] * 3, [0.75] * 3])).tolist() == [-0.25, 0.25]
    near = scene.compute_closest_points(points)
    assert near["geometry_ids"].tolist()[2] == 1 and np.allclose(near["points"][2], [3.5, 0.5, 1])
    inner, outer = [[10, 0, 4], [0, 10, 3], [0, 0, 1]], np.eye(4)
    # Results have the shape of the rays, except lists of all hits, which are flat.
    many = np.broadcast_to(rays, (2, 4, 3, 6)).copy()
    assert {name: answer.shape[3:] for name, answer in scene.cast_rays(many).items() if answer.shape[:3] == (2, 4, 3)} == {
        "t_hit": (), "geometry_ids": (), "primitive_ids": (), "primitive_uvs": (2,), "primitive_normals": (3,)
    }  # fmt: skip
    listed = scene.list_intersections(many)
    assert listed["ray_splits"].shape == (25,) and listed["primitive_uvs"].shape == (8 * 6, 2)

    class Tensor:
        def __init__(self, values):
            self.values = values

        def numpy(self):
            return self.values

    class Theirs:
        vertex = type("Vertex", (), {"positions": Tensor(CUBE)})
        triangle = type("Triangle", (), {"indices": Tensor(CUBE_FACES)})

    own = durer.open3d.RaycastingScene()
    assert own.add_triangles(Theirs()) == 0 and own.count_intersections(rays).tolist() == [2, 0, 0]
    made = scene.create_rays_pinhole(inner, outer, 8, 6)
    assert made.shape == (6, 8, 6) and np.allclose(made[0, 0, 3:], [-0.35, -0.25, 1])


def test_embreex_calls_answer():
    scene = durer.embreex.EmbreeScene()
    durer.embreex.TriangleMesh(scene, CUBE, CUBE_FACES)
    o, d = np.array([[-1, 0.5, 0.25], [5, 5, 5]], "f4"), np.array([[1, 0, 0]] * 2, "f4")
    assert (scene.run(o, d) >= 0).tolist() == [True, False]
    assert scene.run(o, d, query="OCCLUDED").tolist() == [0, -1]
    assert scene.run(o, d, query="DISTANCE").tolist() == [1, np.float32(1e37)]
    assert set(scene.run(o, d, output=True)) == {"u", "v", "Ng", "tfar", "primID", "geomID"}
    # Rays that miss keep their end, and have no surface attributes.
    told = scene.run(o, d, output=True, dists=100)
    assert told["tfar"].tolist() == [1, 100] and told["primID"][1] == told["geomID"][1] == -1
    assert told["u"][1] == told["v"][1] == 0 and told["Ng"].tolist() == [[-1, 0, 0], [0, 0, 0]]
    assert scene.run(o, d, query="DISTANCE", dists=np.float32([0.5, 3])).tolist() == [0.5, 3]
    durer.embreex.EmbreeScene(durer.embreex.EmbreeDevice())
    with pytest.raises(ValueError, match="query type"):
        scene.run(o, d, query="X")


def test_elements_are_closed_and_seen_from_outside():
    square = np.float32([[1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0]])
    cube = np.concatenate([square, square + np.float32([0, 0, 1])])
    for corners, volume in ((np.eye(4, 3, -1, dtype="f4"), 1 / 6), (cube, 1)):
        scene = durer.embreex.EmbreeScene()
        durer.embreex.ElementMesh(scene, corners, np.arange(len(corners))[None])
        (mesh,) = scene.meshes
        a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(float) for i in range(3))
        # The divergence theorem gives the volume; faces with the wrong orientation would count as
        # negative.
        assert mesh.is_closed and np.isclose((a * np.cross(b, c)).sum() / 6, volume)
    with pytest.raises(NotImplementedError, match="4 or 8 corners"):
        durer.embreex.ElementMesh(scene, cube, [[0, 1, 2]])


def test_modules_are_imported_on_first_access():
    import subprocess
    import sys

    words = "import durer; durer.farm.render, durer.vision.Camera, durer.embreex.EmbreeScene; assert 'farm' in dir(durer)"
    subprocess.run([sys.executable, "-c", words], check=True)
    with pytest.raises(AttributeError, match="no attribute 'farms'"):
        durer.farms


def test_trimesh_takes_our_rays():
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.Trimesh(*sphere())
    theirs = trimesh.ray.ray_triangle.RayMeshIntersector(mesh)
    ours = durer.trimesh.RayMeshIntersector(mesh)
    o, d = 3 * directions(400, 21), directions(400, 22)
    d[:200] = -o[:200] + 0.3 * directions(200, 23)
    assert (ours.intersects_any(o, d) == theirs.intersects_any(o, d)).all()
    # Directions can have any length.
    for scale in (1e-300, 1e-20, 1e20, 1e300):
        assert (ours.intersects_first(o, scale * d) == ours.intersects_first(o, d)).all()
    assert (ours.intersects_first(o, d) == theirs.intersects_first(o, d)).all()
    for many in (True, False):
        a, b = ours.intersects_location(o, d, many), theirs.intersects_location(o, d, multiple_hits=many)
        order = [np.lexsort((x[2], x[1])) for x in (a, b)]
        assert (a[1][order[0]] == b[1][order[1]]).all() and (a[2][order[0]] == b[2][order[1]]).all()
        assert np.allclose(a[0][order[0]], b[0][order[1]], atol=1e-5)
    mesh.ray = ours
    p = np.random.default_rng(3).uniform(-1.2, 1.2, (2000, 3))
    assert (mesh.contains(p) == ours.contains_points(p)).all()
    r = np.linalg.norm(p, axis=1)
    clear = (r < 0.98) | (r > 1)
    assert (mesh.contains(p) == (r < 1))[clear].all()
    mesh.apply_translation([100, 0, 0])
    assert ours.contains_points(p + [100, 0, 0])[clear].tolist() == (r < 1)[clear].tolist()
    import copy
    import pickle

    assert copy.deepcopy(ours).intersects_any(o + [100, 0, 0], d).any()
    assert pickle.loads(pickle.dumps(ours)).intersects_any(o + [100, 0, 0], d).any()
