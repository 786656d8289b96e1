"""Tests of surface points: normals, secondary rays, distant meshes, and copies."""

import copy
import pickle

import numpy as np
import pytest
from test_rays import CUBE, CUBE_FACES, directions, sphere

import durer


def bumpy() -> tuple[np.ndarray, np.ndarray]:
    """Returns a closed mesh with hollows and folds."""
    vertices, faces = sphere(32)
    return vertices * (1 + 0.3 * np.sin(7 * vertices).prod(1))[:, None], faces


SHAPES = {"ball": sphere(), "cube": (2 * CUBE - 1, np.array(CUBE_FACES)), "bumpy": bumpy()}


def check_secondary_rays(scene, middle, seed):
    """Checks that secondary rays in any direction start on the side of their direction."""
    middle = np.asarray(middle, np.float64)
    for way in (directions(20_000, seed), None):
        origins = middle if way is None else middle + 3 * way
        goals = middle + np.random.default_rng(seed).uniform(-0.6, 0.6, (20_000, 3))
        hits = scene.closest(origins, goals - origins)
        assert hits.hit.sum() > 15_000
        hits = hits[hits.hit]
        ways = directions(len(hits), seed + 1).astype("f4")
        starts = hits.leave(ways)
        assert starts.dtype == np.float64 and np.abs(starts - hits.point).max() < 1e-3
        cosine = (hits.normal.astype(float) * ways).sum(1)
        crossings = scene.count(starts, ways)
        assert (crossings[cosine > 1e-6] % 2 == 0).all() and (crossings[cosine < -1e-6] % 2 == 1).all()
        again = scene.closest(starts, ways)
        assert not ((again.triangle == hits.triangle) & (again.object == hits.object)).any()


@pytest.mark.parametrize("offset", [0, 1000, 4e6])
@pytest.mark.parametrize("shape", SHAPES)
def test_secondary_rays_do_not_hit_their_origin(shape, offset):
    vertices, faces = SHAPES[shape]
    middle = [offset, -offset / 3, 0.0]
    mesh = durer.Mesh(vertices + middle, faces)
    assert mesh.is_closed
    check_secondary_rays(mesh, middle, 21)
    if offset == 1000:
        single = durer.Mesh((vertices + middle).astype("f4"), faces)
        assert single.vertices.dtype == np.float64 and (single.vertices == (vertices + middle).astype("f4")).all()
        check_secondary_rays(single, middle, 22)


@pytest.mark.parametrize("offset", [0, 1000, 4e6])
@pytest.mark.parametrize("matrix", [np.eye(3), np.diag([-1, 1, 1]), [[0, -1.5, 0], [1, 0, 0.5], [0, 0.2, 0.9]]])
def test_secondary_rays_on_instances(matrix, offset):
    middle = np.array([offset, -offset / 3, 0.0])
    place = np.column_stack([matrix, middle])
    check_secondary_rays(durer.Scene([(durer.Mesh(*SHAPES["bumpy"]), place)]), middle, 23)
    far = durer.Mesh(SHAPES["bumpy"][0] + 5000, SHAPES["bumpy"][1])
    place[:, 3] -= place[:, :3] @ [5000, 5000, 5000]
    check_secondary_rays(durer.Scene([(far, place)]), middle, 24)


def test_secondary_rays_on_all_shapes():
    camera = durer.PerspectiveCamera(center=(0, 1, 8), direction=(0, -0.1, -1), up=(0, 1, 0), angle=40)
    for offset in (0, 1000, 1e5):
        middle = np.array([offset, 0, 0.0])
        ball = durer.Sphere(center=middle, radius=1)
        for item in (ball, durer.Mesh(SHAPES["ball"][0] + middle, SHAPES["ball"][1])):
            world = durer.World(camera, [item], [])
            hits = world.closest(middle + 3 * directions(5000, 25), -directions(5000, 25))
            ways = directions(5000, 26).astype("f4")
            inside = (hits.normal * ways).sum(1) < 0
            assert hits.hit.all() and (world.occluded(hits.leave(ways), ways) == inside).all()


def test_secondary_rays_of_several_directions_and_of_misses():
    mesh = durer.Mesh(*SHAPES["ball"])
    hits = mesh.closest([[0, 0, 3], [0, 0, 3]], [[0, 0, -1], [0, 0, 1]])
    starts = hits[:, None].leave(directions(7))
    assert starts.shape == (2, 7, 3) and np.isfinite(starts[0]).all() and np.isnan(starts[1]).all()
    assert (hits.leave([0, 0, 1])[0] == hits[0].leave([0, 0, 1])).all() and hits[0].t.shape == ()
    assert not mesh.occluded(hits.leave([0, 0, -1])[1], [0, 0, -1])
    with pytest.raises(ValueError, match=r"must be broadcastable with the shape \(2, 3\), but have the shape \(3, 3\)"):
        hits.leave(np.ones((3, 3)))
    every = mesh.all_hits([0, 0.1, 3], [0, 0, -1])
    assert (every.normal[:, 2] * [1, -1] > 0.9).all() and np.allclose(every.point[:, 2], 3 - every.t, atol=1e-6)
    assert (mesh.count(every.leave([0, 0, -1]), [0, 0, -1]) == [1, 0]).all()


def test_surface_points_give_secondary_origins():
    mesh = durer.Mesh(*SHAPES["bumpy"])
    o, ways = 3 * directions(2000, 38), directions(2000, 39)
    hits, near = mesh.closest(o, -o), mesh.nearest(o)
    same = mesh.surface(hits.triangle, hits.uv)
    assert (same.leave(ways) == hits.leave(ways)).all() and (same.point == hits.point).all() and (same.t == 0).all()
    there = mesh.surface(near.triangle, near.uv)
    assert np.allclose(there.point, near.point, atol=1e-6)
    assert (mesh.count(there.leave(ways), ways) % 2 == ((there.normal * ways).sum(1) < 0)).all()
    with pytest.raises(ValueError, match="each point needs u, v and the index of one of the 12 triangles"):
        durer.Mesh(CUBE, CUBE_FACES).surface([12], [[0, 0]])


def test_a_mesh_far_away_is_as_exact_as_one_at_the_origin():
    vertices, faces = SHAPES["bumpy"]
    here = durer.Mesh(vertices, faces)
    place = np.array([450_123.25, 5_411_987.5, 312.0])
    there, placed = durer.Mesh(vertices + place, faces), durer.Scene([(here, np.column_stack([np.eye(3), place]))])
    o, d = 3 * directions(4000, 27), directions(4000, 28)
    near = here.closest(o, -o + d)
    for far in (there, placed, durer.Scene([there])):
        hits = far.closest(o + place, -o + d)
        assert (hits.hit == near.hit).mean() > 0.999
        both = hits.hit & near.hit
        assert hits.point.dtype == np.float64 and np.abs(hits.point - near.point - place)[both].max() < 1e-5
        p = np.random.default_rng(29).uniform(-1.5, 1.5, (2000, 3))
        assert np.abs(far.distance(p + place, signed=True) - here.distance(p, signed=True)).max() < 1e-6
    world = durer.World(
        durer.PerspectiveCamera(center=place + [0, 0, 8], direction=(0, 0, -1), up=(0, 1, 0), angle=40), [there], []
    )
    assert np.allclose(world.closest(o + place, -o + d).t[near.hit], near.t[near.hit], atol=1e-5)
    assert np.abs(there.bounds - place - here.bounds).max() < 1e-6
    moved = pickle.loads(pickle.dumps(there))
    assert (moved.closest(o + place, -o + d).t == there.closest(o + place, -o + d).t).all()


def test_a_mesh_does_not_change_with_the_arrays_it_was_made_of():
    vertices, faces = CUBE.copy(), np.array(CUBE_FACES, np.uint32)
    mesh = durer.Mesh(vertices, faces)
    vertices *= 10
    faces[:] = 0
    hits = mesh.closest([0.5, 0.4, 5], [0, 0, -1])
    assert hits.t == 4 and np.allclose(hits.point, [0.5, 0.4, 1]) and (hits.normal == [0, 0, 1]).all()
    assert durer.Scene([mesh]).distance([0.5, 0.5, 2]) == 1 and mesh.is_closed
    for array in (mesh.vertices, mesh.faces):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_non_finite_and_duplicate_triangles_are_open():
    faces = np.array(CUBE_FACES)
    for wrong in (np.nan, np.inf):
        vertices = CUBE.copy()
        vertices[3, 1] = wrong
        mesh = durer.Mesh(vertices, faces)
        gone = (faces == 3).any(1)
        assert not mesh.is_closed and mesh.open_edges == gone.sum() == durer.Mesh(CUBE, faces[~gone]).open_edges
        camera = durer.PerspectiveCamera(center=(0, 1, 8), direction=(0, -0.1, -1), up=(0, 1, 0), angle=40)
        o, d = 3 * directions(2000, 30) + 0.5, -directions(2000, 30)
        seen = durer.World(camera, [mesh], []).closest(o, d)
        assert (seen.triangle == mesh.closest(o, d).triangle).all() and (mesh.count(o, d) % 2 == 1).any()
    twice = durer.Mesh(CUBE, np.concatenate([faces, np.roll(faces, 1, 1)]))
    assert twice.open_edges == 18 and not twice.is_closed
    one = durer.Mesh(CUBE, np.concatenate([faces, faces[:1], faces[:1]]))
    assert one.open_edges == 3
    # Two triangles with opposite orientations form a closed sheet without thickness, whose inside
    # is empty.
    sheet = durer.Mesh(CUBE, [[0, 1, 3], [3, 1, 0]])
    assert sheet.is_closed and not sheet.contains([[0, 0.3, 0.5]]).any()
    assert durer.Mesh(np.zeros((0, 3)), np.zeros((0, 3), int)).is_closed
    with pytest.raises(ValueError, match=r"vertices\[1\] is \[0.0, 0.0, 1e\+39\], which exceeds the range of"):
        durer.Mesh(CUBE.astype(float) * 1e39, faces)


def test_mirrored_normals_point_outwards_as_those_of_worlds():
    mesh, mirror = durer.Mesh(*SHAPES["ball"]), np.diag([-1.0, 2, 1, 1])
    o = 3 * directions(500, 31)
    placed = durer.Scene([(mesh, mirror)]).closest(o, -o)
    camera = durer.PerspectiveCamera(center=(0, 1, 8), direction=(0, -0.1, -1), up=(0, 1, 0), angle=40)
    world = durer.World(camera, [durer.Model(mesh).at(mirror)], []).closest(o, -o)
    assert ((placed.normal * o).sum(1) > 0).all() and np.allclose(placed.normal, world.normal, atol=1e-6)


def test_meshes_scenes_and_hits_can_be_pickled():
    mesh = durer.Mesh(*SHAPES["bumpy"], preset="best")
    scene = durer.Scene([mesh, (mesh, np.diag([1, 2, -1, 1.0]))])
    o, d = 3 * directions(300, 32), -directions(300, 33)
    for thing in (mesh, scene):
        for other in (pickle.loads(pickle.dumps(thing)), copy.deepcopy(thing), copy.copy(thing)):
            assert (other.closest(o, d).t == thing.closest(o, d).t).all() and repr(other) == repr(thing)
        for answer in (thing.closest(o, d), thing.all_hits(o, d), thing.nearest(o)):
            for other in (pickle.loads(pickle.dumps(answer)), copy.deepcopy(answer)):
                assert (other.triangle == answer.triangle).all() and np.array_equal(other.point, answer.point, equal_nan=True)


def test_points_and_normals_have_the_same_bits_with_any_threads():
    mesh = durer.Mesh(*SHAPES["bumpy"])
    o, d = 3 * directions(30_000, 34), -directions(30_000, 35)
    one, two = (mesh.closest(o, d, threads=n) for n in (1, 2))
    for name in ("point", "normal"):
        assert np.array_equal(getattr(one, name), getattr(two, name), equal_nan=True)
    assert (one.leave(d)[one.hit] == two.leave(d)[two.hit]).all()
    corners = mesh.vertices[mesh.faces[one.triangle]].astype(float)
    u, v = one.uv[:, :1].astype(float), one.uv[:, 1:].astype(float)
    point = (1 - u - v) * corners[:, 0] + u * corners[:, 1] + v * corners[:, 2]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    assert (one.point == point.astype("f4"))[one.hit].all()
    assert np.allclose(one.normal[one.hit], normal[one.hit], atol=1e-7)


def test_u_and_v_weight_corners_1_and_2():
    mesh, points = durer.Mesh(*SHAPES["bumpy"]), 2 * directions(500, 40)
    for found in (mesh.closest(points, -points), mesh.all_hits(points, -points), mesh.nearest(points)):
        a, b, c = mesh.vertices[mesh.faces[found.triangle]].swapaxes(0, 1)
        u, v = found.uv[:, :1], found.uv[:, 1:]
        assert len(u) >= 500 and np.allclose((1 - u - v) * a + u * b + v * c, found.point, atol=1e-6)


def test_meshes_are_refitted_and_objects_moved():
    vertices, faces = SHAPES["bumpy"]
    mesh = durer.Mesh(vertices, faces)
    o, d = 3 * directions(3000, 36), -directions(3000, 37)
    before = mesh.closest(o, d).t
    for moved in (1.2 * vertices, vertices + 0.1 * np.sin(3 * vertices), vertices + 900):
        fit, new = mesh.refit(moved), durer.Mesh(moved, faces)
        shift = moved.mean(0) - vertices.mean(0)
        for name in ("t", "triangle", "uv", "point"):
            found = (getattr(each.closest(o + shift, d), name) for each in (fit, new))
            assert np.array_equal(*found, equal_nan=True)
        assert (fit.vertices == new.vertices).all() and (fit.bounds == new.bounds).all()
    gone = vertices.copy()
    gone[5] = np.nan
    assert not mesh.refit(gone).is_closed and mesh.refit(gone).refit(vertices).is_closed
    assert (mesh.refit(gone).refit(vertices).closest(o, d).t == before).all() and (mesh.closest(o, d).t == before).all()
    with pytest.raises(ValueError, match="vertices must have the shape"):
        mesh.refit(vertices[1:])
    there = np.diag([1, 2, 1, 1.0])
    scene = durer.Scene([mesh, (mesh, np.eye(4))]).move({1: there})
    assert (scene.closest(o, d).t == durer.Scene([mesh, (mesh, there)]).closest(o, d).t).all()
    with pytest.raises(ValueError, match="there is no object 2: the scene has 2 objects"):
        scene.move({2: there})


def test_area_and_volume():
    for name, (vertices, faces) in SHAPES.items():
        far = durer.Mesh(np.asarray(vertices) + 1e5, faces)
        corners = np.asarray(far.vertices, np.float64)[far.faces]
        crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        volume = ((corners[:, 0] - corners[0, 0]) * crossed).sum() / 6
        assert np.isclose(far.area, np.linalg.norm(crossed, axis=1).sum() / 2, rtol=1e-6), name
        assert np.isclose(far.volume, volume, rtol=1e-6), name
    cube = durer.Mesh(2 * CUBE - 1, CUBE_FACES)
    assert (cube.area, abs(cube.volume)) == (24, 8)
    assert durer.Mesh(2 * CUBE - 1, np.array(CUBE_FACES)[:, ::-1]).volume == -cube.volume
