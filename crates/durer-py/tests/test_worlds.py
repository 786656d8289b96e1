"""Tests of scenes, images and parts against the `durer` command, which is part of the package."""

import asyncio
import copy
import errno
import json
import multiprocessing
import os
import pickle
import re
import subprocess
import sys

import numpy as np
import pytest

import durer

SIZE = "48x36"


def command(*words, cwd=None):
    done = subprocess.run([sys.executable, "-m", "durer", *map(str, words)], capture_output=True, text=True, cwd=cwd)
    return done


@pytest.fixture(scope="module")
def whitted(scenes):
    return durer.load(scenes / "whitted.txt")


def test_picture_equals_command_output(whitted, scenes, tmp_path):
    pictures = whitted.render(size=(48, 36), samples=3, seed=7, show=["color", "depth", "normals"])
    words = ["--size", SIZE, "--samples", 3, "--seed", 7, "--show", "color,depth,normals", "--hash"]
    done = command("render", scenes / "whitted.txt", "-o", tmp_path / "a.exr", *words)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split()[-1] == pictures.hash
    assert pictures["color"].shape == (36, 48, 3) and pictures["depth"].shape == (36, 48)
    assert all(picture.dtype == np.float32 for picture in pictures.values())
    values, display = durer.read(tmp_path / "a.exr")
    assert not display and values.shape == (36, 48, 3)
    pictures.save(tmp_path / "b.exr")
    assert (durer.read(tmp_path / "b.exr")[0] == values).all()
    assert durer.compare(tmp_path / "a.exr", tmp_path / "b.exr")["verdict"] == "identical"


def test_eight_bit_picture_equals_command_output(whitted, scenes, tmp_path):
    whitted.render(size=SIZE).save(tmp_path / "a.png")
    command("render", scenes / "whitted.txt", "-o", tmp_path / "b.png", "--size", SIZE)
    assert (durer.read(tmp_path / "a.png")[0] == durer.read(tmp_path / "b.png")[0]).all()
    assert whitted.render(size=SIZE)._repr_png_().startswith(b"\x89PNG")


def test_explanations_sum_to_the_pixel(whitted):
    options = {"size": (48, 36), "samples": 2}
    told = whitted.explain(20, 20, **options)
    assert np.allclose(told["pixel"]["color"], whitted.render(**options)["color"][20, 20], atol=0)
    with pytest.raises(ValueError, match="crop|pixel|outside"):
        whitted.explain(48, 0, **options)


def test_shards_merge_to_one_run(whitted, tmp_path):
    options = {"size": SIZE, "samples": 4, "show": "color,object"}
    whole = whitted.render(**options)
    parts = [whitted.render(shard=(i, 3), **options).part for i in (1, 2, 3)]
    parts[1].save(tmp_path / "2.part")
    merged = durer.Part.merge([parts[2], tmp_path / "2.part", parts[0].bytes()])
    assert merged.hash == whole.hash and (merged.pictures()["color"] == whole["color"]).all()
    with pytest.raises(durer.RenderError, match="2/3"):
        durer.Part.merge([parts[0], parts[2]])
    with pytest.raises(durer.RenderError, match="overlap"):
        durer.Part.merge([parts[0], parts[0], parts[1]])
    with pytest.raises(durer.RenderError, match="not a part"):
        durer.Part.read(b"something else")
    damaged = bytearray(parts[0].bytes())
    damaged[-40] ^= 1
    with pytest.raises(durer.RenderError, match="damaged"):
        durer.Part.read(bytes(damaged))
    # The program's version follows the magic number and the format's version.
    assert parts[0].shard == "1/3" and parts[0].is_finished and parts[0].job["width"] == 48


def test_part_continues_after_an_error(whitted):
    options = {"size": (640, 480), "samples": 64}
    part, seen = whitted.part(**options), []

    def stop(pictures):
        seen.append(pictures["color"].shape)
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        whitted.render(part=part, callback=stop, every=0.0, **options)
    assert seen == [(480, 640, 3)] and not part.is_finished


def test_progressive_pictures_end_with_the_finished_one(whitted):
    async def all_of():
        return [p.hash async for p in whitted.progressive(every=0.05, size=(64, 48), samples=8)]

    hashes = asyncio.run(all_of())
    assert hashes[-1] == whitted.render(size=(64, 48), samples=8).hash


def test_scene_in_code_equals_text(tmp_path):
    red = durer.PhongMaterial(diffuse_color=(0.8, 0.2, 0.2))
    blue = durer.PhongMaterial(diffuse_color=(0.1, 0.2, 0.9), specular_color=(1, 1, 1), exponent=30)
    tetra = durer.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    hollow = durer.Difference(durer.Box(min=(-1, -1, -1), max=(1, 1, 1)), durer.Sphere(center=(0, 0, 1), radius=0.8).of(red))
    world = durer.World(
        durer.PerspectiveCamera(center=(0, 1, 8), direction=(0, -0.1, -1), up=(0, 1, 0), angle=40),
        [
            hollow.of(blue).at((0, 0.5, 0)),
            durer.Group(tetra, durer.Moved(tetra, np.diag([0.5, 2, 0.5, 1])).of(red)).at((1.5, 0, 1)),
            durer.Plane(normal=(0, 1, 0), offset=-1).of(durer.Checkerboard(material1=red, material2=blue)),
        ],
        [durer.DirectionalLight(direction=(-1, -2, -1), color=(0.9, 0.9, 0.8))],
        durer.Background(color=(0.2, 0.1, 0.5), ambient_light=(0.2, 0.2, 0.2)),
    )
    pictures = world.render(size=SIZE, samples=2, show="color,object,material")
    assert set(np.unique(pictures["material"])) >= {0.0, 1.0, 2.0}
    scene = world.save(tmp_path / "scene")
    words = ["--size", SIZE, "--samples", 2, "--show", "color,object,material", "--hash", "--dialect", "durer"]
    done = command("render", scene, "-o", tmp_path / "a.exr", *words)
    assert done.stdout.split()[-1] == pictures.hash, done.stderr
    assert durer.World.from_text(world.text, tmp_path / "scene", dialect="durer").digest == world.digest
    assert world.check(size=SIZE) == [] or all("code" in finding for finding in world.check(size=SIZE))


def test_errors_of_scenes_tell_file_line_and_column(tmp_path):
    (tmp_path / "bad.txt").write_text("PerspectiveCamera {\n  center 0 0 0\n  direction 0 0 oops\n}\n")
    with pytest.raises(durer.SceneError, match=r"bad\.txt:3:\d+: error") as raised:
        durer.load(tmp_path / "bad.txt")
    assert raised.value.__context__ is None
    for error in (raised.value, pickle.loads(pickle.dumps(raised.value))):
        assert error.file.endswith("bad.txt") and (error.line, error.column) == (3, 17) and isinstance(error, ValueError)
        assert str(error).startswith(f"{error.file}:3:17: error: ") and error.findings[0]["severity"] == "error"
    found = durer.check(tmp_path / "bad.txt")
    assert found[0]["severity"] == "error" and found[0]["place"]["line"] == 3
    with pytest.raises(FileNotFoundError, match="nothing.txt") as missing:
        durer.load(tmp_path / "nothing.txt")
    assert missing.value.errno == errno.ENOENT and os.fspath(missing.value.filename) == str(tmp_path / "nothing.txt")
    with pytest.raises(durer.SceneError, match="radius"):
        durer.World(durer.OrthographicCamera(center=(0, 0, 5), direction=(0, 0, -1), up=(0, 1, 0), size=3),
                    [durer.Sphere(center=(0, 0, 0), radius=-1)])  # fmt: skip


def test_check_equals_command(tmp_path, scenes):
    text = (scenes / "whitted.txt").read_text()
    dark = re.sub(r"Lights \{.*?\n\}", "Lights { }", text, flags=re.S)
    (tmp_path / "dark.txt").write_text(dark)
    done = command("check", tmp_path / "dark.txt", "--json")
    wanted = [finding["code"] for finding in json.loads(done.stdout)["scenes"][0]["findings"]]
    assert [finding["code"] for finding in durer.check(tmp_path / "dark.txt")] == wanted


def test_invalid_options_are_refused(whitted):
    with pytest.raises(TypeError, match="did you mean samples"):
        whitted.render(sample=3)
    with pytest.raises(ValueError, match="samples"):
        whitted.render(samples=0)
    with pytest.raises(ValueError, match="colour"):
        whitted.render(show="colour")
    with pytest.raises(TypeError, match="did you mean dialect"):
        durer.load("x.txt", dialekt="f04")
    for wrong, said in [
        ({"size": 64}, "^size must be width and height, whole numbers, but is 64$"),
        ({"size": (64,)}, "size must be width and height"),
        ({"size": (-64, 4)}, "size must be width and height"),
        ({"size": "64"}, r'^size cannot be 64: expected \(640, 480\) or "640x480"$'),
        ({"crop": (1, 2)}, "crop must be left, top, width and height"),
        ({"samples": "many"}, "^samples cannot be many"),
        ({"noise_threshold": "a"}, "^noise_threshold cannot be a"),
        ({"show": "dept"}, "^show cannot be dept: expected one of color, depth, "),
        ({"depth_range": 3}, "depth_range must be two numbers"),
    ]:
        with pytest.raises(ValueError, match=said) as raised:
            whitted.render(**wrong)
        assert "--" not in str(raised.value)
    for x in (-1, 0.5, 1 << 40):
        with pytest.raises(ValueError, match="x must be a pixel coordinate, a whole number of 0 or more, but is"):
            whitted.explain(x, 0)
    assert "samples" in durer.options() and "output" not in durer.options() and "depth" in durer.kinds()


def test_arguments_of_a_wrong_type_are_named(whitted, tmp_path):
    camera = durer.PerspectiveCamera(center=(0, 0, 5), direction=(0, 0, -1), up=(0, 1, 0), angle=40)
    ball, pictures = durer.Sphere(center=(0, 0, 0), radius=1), whitted.render(size=(8, 6), samples=1)
    for wrong, said in [
        (lambda: durer.World(None, []), "camera must be a camera such as PerspectiveCamera, but is of type NoneType"),
        (lambda: durer.World(camera, ball), "objects must be a list of shapes, .*, but is of type Sphere"),
        (lambda: durer.World(camera, [ball], [3]), r"lights\[0\] must be a light such as PointLight, but is of type int"),
        (lambda: durer.World(camera, [ball], [], "red"), "background must be a Background, or None, but is of type str"),
        (lambda: ball.of("red"), "material must be a material such as PhongMaterial, but is of type str"),
        (lambda: whitted.denoise(pictures["color"]), "pictures must be the result of render, or a Part, but is of type ndarray"),
        (lambda: whitted.render(part=pictures), "part must be a Part, or None, but is of type Pictures"),
        (lambda: whitted.render(callback=3), "callback must be a function of the images, but is of type int"),
        (lambda: whitted.render(progress=3), "progress must be a function of two numbers, .*, but is of type int"),
        (lambda: durer.Model(3), "mesh must be a Mesh, or an object with vertices and faces, but is of type int"),
        (lambda: durer.Moved(3, (0, 0, 0)), "objects must be shapes, meshes, groups or solids, but 3 is of type int"),
    ]:
        with pytest.raises(TypeError, match=f"^{said}$"):
            wrong()
    with pytest.raises(ValueError, match=r"^place must be three numbers, or a matrix, 3 x 4 or 4 x 4, but has the shape \(2,\)$"):
        ball.at((1, 2))
    path = tmp_path / "none" / "a.png"
    with pytest.raises(FileNotFoundError) as raised:
        pictures.save(path)
    assert str(raised.value) == f"cannot write `{path}`: the folder `{path.parent}` does not exist"
    (tmp_path / "a.png").mkdir()
    with pytest.raises(OSError) as raised:
        pictures.save(tmp_path / "a.png")
    assert raised.value.filename == str(tmp_path / "a.png") and os.listdir(tmp_path) == ["a.png"]


def test_objects_with_vertices_and_faces_are_meshes():
    class Trimesh:
        vertices, faces = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]

    camera, other = durer.PerspectiveCamera(center=(0, 0, 5), direction=(0, 0, -1), up=(0, 1, 0), angle=40), Trimesh()
    worlds = [durer.World(camera, [item]) for item in (durer.Mesh(other), other, durer.Model(other))]
    assert len({world.digest for world in worlds}) == 1
    durer.World(camera, [durer.Moved(other, (1, 0, 0))])


def test_progress_ends_with_the_total(whitted):
    told = []

    def tell(done, total):
        told.append((done, total))

    whitted.render(size=(64, 64), samples=64, progress=tell)
    whitted.render(size=(64, 64), samples=64, noise_threshold=0.5, progress=tell)
    assert told[-1] == (64**3, 64**3) and {total for _, total in told} == {64**3}
    told.clear()
    whitted.measure(np.ones((7, 3)), samples=64, progress=tell)
    assert told[-1] == (7, 7) and {total for _, total in told} == {7}


def test_camera_rays_are_those_of_the_depth(whitted):
    fisheye = durer.FisheyeCamera(center=(0, 0, 5), direction=(0, 0, -1), up=(0, 1, 0), angle=180)
    for world in (whitted, durer.World(fisheye, [durer.Sphere(center=(0, 0, 0), radius=1)])):
        for options in ({"size": (40, 30)}, {"size": (40, 30), "crop": (16, 11, 7, 9)}):
            origins, directions = world.rays(**options)
            depth = world.render(samples=1, show="depth", **options)["depth"]
            assert origins.shape == directions.shape == (*depth.shape, 3) and origins.dtype == directions.dtype == np.float64
            found = world.closest(origins, directions)
            assert (np.where(found.hit, found.t, 0) == depth).all() and found.hit.any()
            seen = ~np.isnan(directions[..., 0])
            assert np.allclose(np.linalg.norm(directions[seen], axis=-1), 1) and (np.isnan(origins[..., 0]) == ~seen).all()
    corner = durer.World(fisheye, []).rays(size=(8, 8))[1][0, 0]
    assert np.isnan(corner).all()
    with pytest.raises(ValueError, match="size must be width and height"):
        whitted.rays(size=3)


def test_pictures_are_compared():
    a = np.zeros((32, 32, 3), np.float32)
    b = a.copy()
    b[4:8, 4:8] = 1
    found = durer.compare(a, b)
    assert found["verdict"] == "different" and found["flip_map"].shape == (32, 32)
    assert found["flip_map"][6, 6] > 0.5 > found["flip_map"][30, 30]
    assert durer.compare((255 * a).astype("u1"), (255 * a).astype("u1"))["verdict"] == "identical"
    with pytest.raises(ValueError, match="different sizes"):
        durer.compare(a, b[:16])
    with pytest.raises(ValueError, match=r"\(height, width, 3\)"):
        durer.compare(a, b[..., 0])


def test_command_prints_its_output():
    assert command("--version").stdout.startswith("durer ")
    assert command("render", "nothing.txt").returncode == 2


def test_rays_agree_with_pictures() -> None:
    ball = durer.Sphere(center=(0, 0, 0), radius=1)
    red = durer.PhongMaterial(diffuse_color=(1, 0, 0))
    camera = durer.PerspectiveCamera(center=(0, 0, 5), direction=(0, 0, -1), up=(0, 1, 0), angle=30)
    cube = durer.Mesh(
        [[x, y, z] for x in (3, 4) for y in (0, 1) for z in (0, 1)],
        [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]],
    )  # fmt: skip
    world = durer.World(camera, [durer.Plane(normal=(0, 1, 0), offset=-1), ball.of(red), durer.Model(cube)], None)
    origins = [[0, 0, 5], [0.5, 4, 0.5], [9, 4, 9], [3.5, 5, 0.4], [0, 5, 9], [np.nan, 0, 0]]
    directions = [[0, 0, -2], [0, -1, 0], [0, -1, 0], [0, -1, 0], [0, 1, 0], [0, 0, 1]]
    found = world.closest(origins, directions)
    height = np.sqrt(0.5)
    np.testing.assert_allclose(found.t, [2, 4 - height, 5, 4, np.inf, np.inf], rtol=1e-6)
    np.testing.assert_allclose(found.point[:4], [[0, 0, 1], [0.5, height, 0.5], [9, -1, 9], [3.5, 1, 0.4]], atol=1e-6)
    np.testing.assert_allclose(found.normal[:4], [[0, 0, 1], [0.5, height, 0.5], [0, 1, 0], [0, 1, 0]], atol=1e-6)
    assert found.hit.tolist() == [True] * 4 + [False] * 2
    assert np.isnan(found.point[4:]).all() and (found.material[4:] == -1).all()
    # The indices are those of the pictures.
    picture = world.render(size=(9, 9), show="object,material,depth", samples=1)
    middle = {name: picture[name][4, 4] for name in ("object", "material", "depth")}
    assert middle == {"object": found.object[0], "material": found.material[0], "depth": 2 * found.t[0]}
    assert found.object[0] != found.object[2] and found.triangle[3] in (6, 7)
    assert world.occluded(origins, directions).tolist() == found.hit.tolist()
    assert world.occluded(origins, directions, t_max=found.t).sum() == 0
    shaped = world.closest(np.zeros((2, 1, 3)) + [0, 0, 5], np.array([[0, 0, -1.0]] * 3))
    assert shaped.t.shape == (2, 3) and shaped.normal.shape == (2, 3, 3)
    with pytest.raises(ValueError, match="directions must have the shape"):
        world.closest([0, 0, 0], [1, 2])
    one = world.closest(np.random.default_rng(1).normal(size=(5000, 3)) * 4, [0, -1, 0.1], threads=1)
    two = world.closest(np.random.default_rng(1).normal(size=(5000, 3)) * 4, [0, -1, 0.1], threads=2)
    assert all(np.array_equal(getattr(one, n), getattr(two, n), equal_nan=True) for n in ("t", "object", "point", "shading_normal"))


def test_model_conversion_is_reported(tmp_path):
    (tmp_path / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    size, usual = (32, 24), durer.load(tmp_path / "m.obj").render(size=(32, 24), samples=1).hash
    for options, words in [({}, []), ({"view": "front"}, ["--view", "front"]), ({"up": "z", "studio": "sun"}, ["--up", "z", "--studio", "sun"])]:
        done = command("render", tmp_path / "m.obj", "-o", tmp_path / "m.png", "--size", "32x24", "--samples", 1, "--hash", *words)
        assert done.returncode == 0, done.stderr
        world = durer.load(tmp_path / "m.obj", size=size, **options)
        found = world.render(samples=1).hash
        assert found in done.stdout and found != usual and world.render(samples=1, size=size).hash == found
        assert world.render(samples=1, size=(8, 8))["color"].shape == (8, 8, 3)
    with pytest.raises(TypeError, match="view is an option of durer.load"):
        durer.load(tmp_path / "m.obj").render(view="front")


def _picture_in_child(queue, world):
    pictures = world.render(size=(40, 30), samples=2)
    world.check(size=(40, 30))
    queue.put((pictures.hash, durer.compare(pictures, pictures)["verdict"], len(pictures.file("a.exr"))))


@pytest.mark.skipif(sys.platform == "win32", reason="there is no fork")
def test_a_fork_renders_after_its_parent_did(whitted):
    here = whitted.render(size=(40, 30), samples=2)
    whitted.check(size=(40, 30))
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=_picture_in_child, args=(queue, whitted))
    child.start()
    try:
        assert queue.get(timeout=60) == (here.hash, "identical", len(here.file("a.exr")))
    finally:
        child.kill()
        child.join()


def test_part_continues_with_its_options(whitted):
    part = whitted.part(size=(40, 30), samples=2)
    for wrong in ({"size": (20, 15)}, {"samples": 3}, {"show": "depth"}, {"shard": (1, 2)}, {"threads": 1, "seed": 4}):
        name = list(wrong)[-1]
        with pytest.raises(ValueError, match=f"a different image than the options {name} would give"):
            whitted.render(part=part, **wrong)
    with pytest.raises(ValueError, match="a different image than the options size, samples would give"):
        whitted.render(part=durer.Part.read(part.bytes()), size=(40, 30), samples=3)
    same = whitted.render(part=part, size="40x30", threads=1, time_limit=100)
    assert same.hash == whitted.render(size=(40, 30), samples=2).hash
    assert whitted.render(part=durer.Part.read(part.bytes()), size=(40, 30), samples=2).hash == same.hash

    def fail(pictures):
        raise ValueError("--size is none of it")

    with pytest.raises(ValueError, match="^--size is none of it$"):
        whitted.render(size=(400, 300), samples=100, callback=fail, every=0)


def test_worlds_parts_and_pictures_can_be_pickled_and_copied(whitted):
    tetra = durer.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    camera = durer.PerspectiveCamera(center=(0, 1, 8), direction=(0, -0.1, -1), up=(0, 1, 0), angle=40)
    for world in (whitted, durer.World(camera, [tetra], [])):
        for other in (pickle.loads(pickle.dumps(world)), copy.deepcopy(world)):
            assert other.digest == world.digest and other.text == world.text
    pictures = whitted.render(size=(40, 30), samples=1, show="color,depth")
    for thing in (pictures, pictures.part):
        for other in (pickle.loads(pickle.dumps(thing)), copy.deepcopy(thing)):
            assert other.hash == pictures.hash
    other = pickle.loads(pickle.dumps(pictures))
    assert list(other) == list(pictures) and all((other[name] == pictures[name]).all() for name in pictures)


def test_model_ground_can_be_omitted(tmp_path):
    mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (tmp_path / "a.obj").write_text(mesh)
    down = ([5, 5, 5], [0.1, -1, 0.1])
    assert durer.load(tmp_path / "a.obj").occluded(*down)
    for none in (False, None, "none"):
        world = durer.load(tmp_path / "a.obj", studio=none)
        assert not world.occluded(*down) and world.closest([0.2, 0.2, 5], [0, 0, -1]).hit


def test_depth_of_background(whitted):
    camera = durer.PerspectiveCamera(center=(0, 0, 5), direction=(0, 0, -1), up=(0, 1, 0), angle=60)
    pictures = durer.World(camera, [durer.Sphere(center=(0, 0, 0), radius=1)], []).render(size=(16, 16), samples=1, show="depth,normals")
    assert pictures["depth"][0, 0] == 0 and pictures["depth"][8, 8] == pytest.approx(4, abs=0.1)
    assert (pictures["normals"][0, 0] == 0).all() and "0 for a miss" in durer.kinds()["depth"]


def test_denoised_pictures_are_closer_to_the_noiseless_one():
    world = durer.World.from_text(
        """PerspectiveCamera { center 0 1 5 direction 0 -0.2 -1 up 0 1 0 angle 40 }
        Background { color 0.6 0.7 0.9 }
        Materials { PrincipledMaterial { baseColor 0.7 0.4 0.3 specularWeight 0 } }
        Group { MaterialIndex 0 Sphere { center 0 0.5 0 radius 1 } Plane { normal 0 1 0 offset -0.5 } }""",
        dialect="durer",
    )
    truth = world.render(size=(48, 48), samples=512, seed=1)["color"]
    noisy = world.render(size=(48, 48), samples=4)
    clean = world.denoise(noisy, threads=1)["denoised"]
    assert clean.shape == (48, 48, 3)
    assert np.abs(clean - truth).mean() < 0.7 * np.abs(noisy["color"] - truth).mean()
    assert (clean == world.denoise(noisy.part)["denoised"]).all()


def test_several_images_are_saved_side_by_side(scenes, tmp_path):
    pictures = durer.load(scenes / "sphere.txt").render(size=(8, 6), samples=1, show="color,depth")
    assert pictures.save(tmp_path / "a.png") == [tmp_path / "a.color.png", tmp_path / "a.depth.png"]
    assert pictures.save(str(tmp_path / "a.exr")) == [tmp_path / "a.exr"]
    values, is_display = durer.read(tmp_path / "a.depth.png")
    assert values.shape == (6, 8, 3) and is_display
    with pytest.raises(ValueError, match="no image 'normals'; the images are color, depth"):
        pictures.file("a.png", layer="normals")


def test_arrays_are_written_as_pictures(tmp_path):
    bytes = np.arange(6 * 8 * 3, dtype=np.uint8).reshape(6, 8, 3)
    durer.write(tmp_path / "bytes.png", bytes)
    assert (np.rint(durer.read(tmp_path / "bytes.png")[0] * 255) == bytes).all()
    light = np.linspace(0, 4, 6 * 8 * 3, dtype=np.float32).reshape(6, 8, 3)
    durer.write(tmp_path / "light.pfm", light)
    assert (durer.read(tmp_path / "light.pfm")[0] == light).all()
    durer.write(tmp_path / "grey.pfm", light[..., 0])
    assert (durer.read(tmp_path / "grey.pfm")[0] == light[..., :1]).all()
    with pytest.raises(ValueError, match="picture must have the shape"):
        durer.write(tmp_path / "wrong.png", np.zeros(5))
