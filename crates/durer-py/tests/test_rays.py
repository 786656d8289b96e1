"""Tests of rays against closed forms, brute force, and invalid input."""

import multiprocessing
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import durer

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
CUBE_FACES = [
    [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
    [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
]  # fmt: skip


def sphere(cuts: int = 24) -> tuple[np.ndarray, np.ndarray]:
    """Returns a closed sphere of radius 1 around the origin, divided by latitude and longitude."""
    theta, phi = np.linspace(0, np.pi, cuts + 1)[1:-1], np.linspace(0, 2 * np.pi, 2 * cuts, endpoint=False)
    t, p = np.meshgrid(theta, phi, indexing="ij")
    ring = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], -1).reshape(-1, 3)
    n, rows = 2 * cuts, cuts - 1
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [[len(ring), i, j], [len(ring) + 1, (rows - 1) * n + j, (rows - 1) * n + i]]
        for r in range(rows - 1):
            a, b, c, d = r * n + i, r * n + j, (r + 1) * n + i, (r + 1) * n + j
            faces += [[a, c, d], [a, d, b]]
    return np.concatenate([ring, [[0, 0, 1], [0, 0, -1]]]), np.array(faces)


@pytest.fixture(scope="module")
def ball() -> durer.Mesh:
    return durer.Mesh(*sphere())


def directions(count: int, seed: int = 1) -> np.ndarray:
    d = np.random.default_rng(seed).normal(size=(count, 3))
    return d / np.linalg.norm(d, axis=1, keepdims=True)


def moller_trumbore(mesh: durer.Mesh, origin: np.ndarray, direction: np.ndarray) -> float:
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(float) for i in range(3))
    p = np.cross(direction, c - a)
    det = ((b - a) * p).sum(1)
    with np.errstate(all="ignore"):
        s = origin - a
        u = (s * p).sum(1) / det
        q = np.cross(s, b - a)
        v, t = (q @ direction) / det, ((c - a) * q).sum(1) / det
    good = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0) & (det != 0)
    return t[good].min() if good.any() else np.inf


def test_closest_equals_brute_force(ball):
    o, d = 1.3 * directions(300, 2), directions(300, 3)
    hits = ball.closest(o, d)
    for i in range(300):
        assert hits.t[i] == pytest.approx(moller_trumbore(ball, o[i].astype("f4"), d[i].astype("f4")), rel=1e-4)
    assert 20 < hits.hit.sum() < 280
    assert (hits.hit == ball.occluded(o, d)).all()
    there = hits.hit
    assert np.allclose(hits.point[there], (o + hits.t[:, None] * d)[there], atol=1e-5)
    assert np.isnan(hits.point[~there]).all() and (hits.normal[~there] == 0).all()
    assert np.allclose(np.linalg.norm(hits.normal[there], axis=1), 1, atol=1e-6)
    assert (np.isinf(hits.t[~there])).all() and (hits.triangle[~there] == -1).all() and (hits.object[~there] == -1).all()


def test_no_ray_is_lost_at_edges_and_vertices(ball):
    corners = ball.vertices[ball.faces]
    goals = np.concatenate([corners[:, 0], (corners[:, 0] + corners[:, 1]) / 2, corners.mean(1)])
    for origin in ([0.1, 0.2, 0.3], [0, 0, 0]):
        d = goals - np.float32(origin)
        assert (ball.count(origin, d) == 1).all()
        assert ball.occluded(origin, d).all()
    outside = np.float32([3, 2, 1])
    assert (ball.count(outside, goals - outside) % 2 == 0).all()


def test_all_hits_are_in_order_and_counted(ball):
    o, d = 3 * directions(5000, 5), directions(5000, 6)
    hits = ball.all_hits(o, d)
    assert (hits.count == ball.count(o, d)).all() and len(hits) == hits.count.sum() == hits.offsets[-1]
    first = hits.offsets[:-1][hits.count > 0]
    assert (hits.t[first] == ball.closest(o, d).t[hits.count > 0]).all()
    same = hits.ray[1:] == hits.ray[:-1]
    assert (np.diff(hits.t)[same] >= 0).all()


def test_contains_knows_the_cube_exactly():
    cube = durer.Mesh(CUBE, CUBE_FACES)
    p = np.random.default_rng(7).uniform(-0.5, 1.5, (100_000, 3)).astype(np.float32)
    assert (cube.contains(p) == ((p > 0) & (p < 1)).all(1)).all()
    assert cube.is_closed
    with pytest.warns(UserWarning, match="3 open edges") as warned:
        durer.Mesh(CUBE, CUBE_FACES[1:]).contains([0.5, 0.5, 0.5])
    assert warned[0].filename == __file__
    assert not cube.contains([[np.nan, 0.5, 0.5], [np.inf, 0, 0]]).any()


def test_distances_are_those_of_the_cube():
    cube = durer.Mesh(CUBE, CUBE_FACES)
    p = np.random.default_rng(8).uniform(-1, 2, (20_000, 3)).astype(np.float32).astype(float)
    q = np.abs(p - 0.5) - 0.5
    exact = np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(1), 0)
    assert np.allclose(cube.distance(p, signed=True), exact, atol=1e-12)
    near = cube.nearest(p)
    assert np.allclose(np.linalg.norm(near.point - p, axis=1), near.distance)
    far = cube.nearest([[9, 9, 9]], within=1.0)
    assert np.isinf(far.distance[0]) and far.triangle[0] == far.object[0] == -1 and np.isnan(far.point).all()


def test_scene_equals_transformed_meshes(ball):
    turn = np.array([[0, -2, 0, 5], [1, 0, 0.5, -1], [0, 0, 3, 2], [0, 0, 0, 1.0]])
    cube = durer.Mesh(CUBE, CUBE_FACES)
    scene = durer.Scene([ball, (cube, turn), (cube, np.eye(4)[:3])])
    flat = scene._joined[0]
    o, d = 6 * directions(4000, 9), directions(4000, 10)
    found, wanted = scene.closest(o, d), flat.closest(o, d)
    assert np.allclose(found.t, wanted.t, rtol=1e-4) and set(found.object) == {-1, 0, 1, 2}
    assert np.allclose(found.point[found.hit], wanted.point[found.hit], atol=1e-4)
    p = np.random.default_rng(1).uniform(-2, 7, (3000, 3))
    inside = ball.contains(p) | cube.contains(p) | cube.contains((p - turn[:3, 3]) @ np.linalg.inv(turn[:3, :3]).T)
    assert (scene.contains(p) == inside).all()
    assert np.allclose(scene.distance(p), flat.distance(p))
    assert set(scene.nearest(p).object) == {0, 1, 2}


def test_any_array_gives_the_same(ball):
    o, d = 3 * directions(1000, 11).astype("f4"), directions(1000, 12).astype("f4")
    wanted = ball.closest(o, d).t
    frozen = o.copy()
    frozen.flags.writeable = False
    strided = np.zeros((1000, 6), "f4")
    strided[:, ::2] = d
    for origins, ways in [
        (o.astype("f8"), d), (np.asfortranarray(o), d), (frozen, strided[:, ::2]), (o.tolist(), d[:, :]),
        (o.astype(">f4"), d), (np.broadcast_to(o, (1, 1000, 3)), d), (o[::-1][::-1], d.astype("f8")),
    ]:  # fmt: skip
        assert (ball.closest(origins, ways).t.reshape(-1) == wanted).all()
    for dtype in ("i4", "i8", "u1" if len(ball.vertices) < 256 else "u2", "f8"):
        assert (durer.Mesh(ball.vertices.astype("f8"), ball.faces.astype(dtype)).closest(o, d).t == wanted).all()

    class Capsule:
        def __dlpack__(self, **options):
            return o.__dlpack__(**options)

        def __dlpack_device__(self):
            return o.__dlpack_device__()

    assert (ball.closest(Capsule(), d).t == wanted).all()


def test_shapes_follow_the_rays(ball):
    d = directions(12, 1).reshape(3, 4, 3)
    hits = ball.closest([0, 0, 0], d)
    assert hits.t.shape == (3, 4) and hits.uv.shape == (3, 4, 2) and hits.point.shape == (3, 4, 3)
    assert ball.closest([0, 0, 0], [0, 0, 1]).t.shape == ()
    record = ball.ray([0, 0, 0], d)
    assert record.dtype == durer.RECORD and (record["t"] == hits.t).all() and (record["normal"] == hits.normal).all()
    assert ball.closest(np.zeros((0, 3)), [0, 0, 1]).t.shape == (0,)
    assert ball.occluded([0, 0, 0], d, t_max=np.full((3, 4), 0.5)).sum() == 0
    assert ball.occluded([0, 0, 0], d, t_max=1.5).all()


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_invalid_rays_hit_nothing(ball, bad):
    hits = ball.closest([[bad, 0, 0], [0, 0, 0], [0, 0, 0]], [[1, 0, 0], [bad, 0, 0], [0, 0, 0]])
    assert not hits.hit.any() and np.isinf(hits.t).all()


def test_threads_change_no_bit(ball):
    o, d = 3 * directions(20_000, 13), directions(20_000, 14)
    one, two = ball.closest(o, d, threads=1), ball.closest(o, d, threads=2)
    for name in ("t", "triangle", "uv"):
        assert (getattr(one, name) == getattr(two, name)).all()


@pytest.mark.parametrize(
    "wrong, said",
    [
        (lambda m: durer.Mesh([[0, 0]], [[0, 0, 0]]), r"vertices must have the shape \(\.\.\., 3\), but has \(1, 2\)"),
        (lambda m: durer.Mesh([[0, 0, 0]], [[0, 0]]), r"faces must have the shape \(n, 3\), but has \(1, 2\)"),
        (lambda m: durer.Mesh([[0, 0, 0]], [[0, 0, 1]]), r"faces\[0\] is \[0, 0, 1\], but there are only 1 vertices"),
        (lambda m: durer.Mesh([[0, 0, 0]], [[0, 0, -1]]), "faces must be 0 or more"),
        (lambda m: durer.Mesh([[0, 0, 0]], [[0, 0, 0.5]]), "faces must be whole numbers"),
        (lambda m: durer.Mesh([[0, 0, 0]], [[0, 0, 0]], "great"), "preset must be 'fast', 'balanced', 'best'"),
        (lambda m: m.closest([[0, 0, 0]] * 2, [[0, 0, 1]] * 3), r"must be broadcastable, but have the shapes \(2, 3\) and \(3, 3\)"),
        (lambda m: m.closest([0, 0, 0], [0, 0, 1], t_max=[1, 2]), r"t_max must be one number or have the shape \(\)"),
        (lambda m: m.closest("here", [0, 0, 1]), "origins must be an array of numbers"),
        (lambda m: m.closest([[0, 0], [1]], [0, 0, 1]), "origins must be an array of numbers"),
        (lambda m: m.closest([0, 0, 0], [0, 0, 1], threads=0), "threads must be a whole number of 1 or more"),
        (lambda m: durer.Scene([(m, np.zeros((4, 4)))]), "the last row of the matrix of object 0 must be 0 0 0 1, but is 0 0 0 0"),
        (lambda m: durer.Scene([(m, np.zeros((3, 4)))]), "the matrix of object 0 cannot be inverted"),
        (lambda m: durer.Scene([3]), "object 0 must be a Mesh"),
        (lambda m: m.closest([0, 0, 0], [0, 0, 1], tmax=2), r"^closest\(\) has no argument tmax: did you mean t_max\?$"),
        (lambda m: m.nearest([0, 0, 0], color=2), r"^nearest\(\) has no argument color: its arguments are points, within, "),
        (lambda m: m.closest([0, 0, 0]), r"^closest\(\) missing 1 required positional argument: 'directions'$"),
        (lambda m: durer.Mesh(m, face=3), r"^Mesh\(\) has no argument face: did you mean faces\?$"),
        (lambda m: m.closest([0, 0, 0], [0, 0, 1], progress=3), "^progress must be a function of two numbers"),
    ],
)
def test_errors_name_expected_values(ball, wrong, said):
    with pytest.raises((ValueError, TypeError), match=said):
        wrong(ball)


def test_progress_is_reported_and_can_stop(ball):
    told = []
    ball.closest(np.zeros((200_000, 3)), [0, 0, 1], progress=lambda done, total: told.append((done, total)))
    assert told[-1][0] == told[-1][1]

    def fail(done, total):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        ball.closest(np.zeros((3_000_000, 3)), directions(3_000_000), threads=1, progress=fail)


def test_gil_is_released(ball):
    """Another Python thread continues to run while rays are traced."""
    ticks, stop = [], threading.Event()
    counter = threading.Thread(target=lambda: [ticks.append(1) or time.sleep(0.001) for _ in iter(stop.is_set, True)])
    d = directions(1_000_000)
    counter.start()
    before = len(ticks)
    ball.count(np.zeros(3), d, threads=1)
    after = len(ticks)
    stop.set()
    counter.join()
    assert after > before


def test_control_c_stops_long_work():
    code = """
import durer, numpy as np, sys
mesh = durer.Mesh(np.random.default_rng(1).random((3000, 3)), np.arange(3000).reshape(-1, 3))
print("ready", flush=True)
try:
    while True:
        mesh.count(np.zeros((2_000_000, 3)), np.ones((2_000_000, 3)), threads=1)
except KeyboardInterrupt:
    print("stopped", flush=True)
"""
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=60)[0] == "stopped\n"


@pytest.mark.parametrize("query", ["count(points, [0, 0, 1])", "nearest(points)"])
def test_control_c_stops_a_few_slow_rays(query):
    """Traces fewer rays than a thread takes at once, each through thousands of stacked
    triangles."""
    code = f"""
import durer, numpy as np
corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=np.float32)
heights = np.arange(100_000, dtype=np.float32)[:, None, None] * [0, 0, 1e-6]
vertices = (corners + heights).reshape(-1, 3)
mesh = durer.Mesh(vertices, np.arange(len(vertices)).reshape(-1, 3))
points = np.full((2000, 3), 0.25) - [0, 0, 1]
print("ready", flush=True)
try:
    while True:
        mesh.{query}
except KeyboardInterrupt:
    print("stopped", flush=True)
"""
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.3)
    start = time.monotonic()
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=60)[0] == "stopped\n"
    # On an idle machine, this takes a tenth of a second.
    assert time.monotonic() - start < 2


def _in_child(queue):
    mesh = durer.Mesh(CUBE, CUBE_FACES)
    queue.put(int(mesh.count(np.full((10_000, 3), 0.5), [0, 0, 1]).sum()))


@pytest.mark.skipif(sys.platform == "win32", reason="there is no fork")
def test_fork_starts_its_own_threads():
    durer.Mesh(CUBE, CUBE_FACES).count(np.full((10_000, 3), 0.5), [0, 0, 1])
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=_in_child, args=(queue,))
    child.start()
    assert queue.get(timeout=60) == 10_000
    child.join()
