"""Examples in docstrings."""

import dataclasses
import doctest
import inspect
import pydoc
import subprocess
import sys

import numpy as np
import pytest

import durer
from durer import words

CORNERS = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]

PUBLIC = [
    getattr(durer, name)
    for name in durer.__all__
    if name not in words.__all__ and hasattr(getattr(durer, name), "__name__")
]
#: Functions whose docstring must have an example.
SHOWN = [durer.Mesh, durer.Scene, durer.load, durer.check, durer.compare, durer.read, durer.options, durer.kinds]


@pytest.fixture
def examples(scenes, tmp_path, monkeypatch):
    """Names that the examples use, in a folder where they can write."""
    (tmp_path / "scenes").symlink_to(scenes)
    monkeypatch.chdir(tmp_path)
    return {"durer": durer, "np": np, "mesh": durer.Mesh(CORNERS, FACES), "world": durer.load("scenes/whitted.txt")}


def test_examples_run(examples):
    finder, runner = doctest.DocTestFinder(exclude_empty=True), doctest.DocTestRunner()
    for thing in PUBLIC:
        for found in finder.find(thing, globs=dict(examples)):
            runner.run(found)
    assert runner.summarize().failed == 0
    assert runner.tries > 40


def test_functions_and_classes_have_examples():
    for thing in SHOWN:
        assert ">>>" in inspect.getdoc(thing), thing


def test_fields_of_results_are_described():
    for result in (durer.Hits, durer.AllHits, durer.Nearest, durer.Surfaces, durer.Illuminance):
        help = pydoc.render_doc(result, renderer=pydoc.plaintext)
        for field in dataclasses.fields(result):
            assert field.name.startswith("_") or f"  {field.name}: " in help, f"{result.__name__}.{field.name}"


def test_views_are_listed():
    from durer._options import OPTIONS

    assert all(f'"{view}"' in durer.World.load.__doc__ for view in OPTIONS["view"].words)


def test_help_without_anywidget():
    code = """
import sys; sys.modules["anywidget"] = None
import durer, pydoc
assert "Hits" in pydoc.render_doc(durer) and not hasattr(durer, "widget")
for statement in ("durer.widget", "from durer import widget", "import durer.widget"):
    try:
        exec(statement)
    except (AttributeError, ImportError) as error:
        print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == 3 * "durer.widget needs anywidget: pip install anywidget\n"


def test_mesh_of_an_object_with_vertices_and_faces():
    class Trimesh:
        vertices, faces = CORNERS, np.array(FACES)

    assert durer.Mesh(Trimesh()).is_closed
    with pytest.raises(TypeError, match="faces are missing"):
        durer.Mesh(CORNERS)


def test_mesh_from_file(scenes, tmp_path):
    mesh = durer.Mesh.from_file(scenes / "meshes" / "durer-solid.obj")
    assert mesh.is_closed and len(mesh.faces) > 8
    (tmp_path / "two.txt").write_text(
        "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 }"
        "Group { Sphere { center 0 0 0 radius 1 } Plane { normal 0 1 0 offset -1 } }"
    )
    with pytest.warns(UserWarning, match="1 objects of .*two.txt are planes or solids"):
        ball = durer.Mesh.from_file(tmp_path / "two.txt")
    assert ball.is_closed and ball.volume == pytest.approx(4 / 3 * np.pi, rel=0.01)
    with pytest.raises(durer.SceneError, match="no triangles"):
        (tmp_path / "plane.txt").write_text(
            "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 } Group { Plane { normal 0 1 0 offset 0 } }"
        )
        durer.Mesh.from_file(tmp_path / "plane.txt")
    with pytest.raises(FileNotFoundError):
        durer.Mesh.from_file(tmp_path / "missing.obj")


def test_measured_light_equals_the_closed_form():
    lit = durer.World.from_text(
        "PerspectiveCamera { center 0 1 5 direction 0 0 -1 up 0 1 0 angle 40 }"
        "Lights { PointLight { position 0 2 0 candela 1000 } }"
        "Materials { PrincipledMaterial { baseColor 0 0 0 specularWeight 0 } }"
        "Group { MaterialIndex 0 Rectangle { corner -9 0 -9 edge0 0 0 18 edge1 18 0 0 } }"
    )
    points = np.array([[(x, 0.0, z) for x in (0, 1)] for z in (0, 1, 2)])
    found = lit.measure(points, samples=16)
    square = 4 + (points[..., [0, 2]] ** 2).sum(-1)
    np.testing.assert_allclose(found.illuminance, 1000 * 2 / square**1.5, rtol=1e-5)
    assert found.irradiance.shape == (3, 2, 3) and found.samples.shape == (3, 2)
    assert 0 < found.uniformity < 1
    sphere = lit.measure(points + (0, 1, 0), kind="spherical", samples=4096)
    np.testing.assert_allclose(sphere.illuminance, 1000 / 4 / (square - 3), rtol=5e-3)
    with pytest.raises(ValueError, match="planar, cylindrical, spherical"):
        lit.measure(points, kind="round")
    with pytest.raises(ValueError, match="normals"):
        lit.measure(points, normals=(0, 0, 0))
    with pytest.raises(ValueError, match="error"):
        lit.measure(points, error=2)


def test_denoised_picture(scenes):
    world = durer.load(scenes / "cornell-box.txt")
    options = {"size": (96, 96)}
    reference = world.render(samples=128, **options)["color"]
    noisy = world.render(samples=8, **options)
    clean = world.denoise(noisy)["denoised"]
    # As displayed: the light itself is far above 1.
    shown = [np.clip(picture, 0, 1) for picture in (reference, noisy["color"], clean)]
    error = [float(np.square(picture - shown[0]).mean()) for picture in shown[1:]]
    assert error[1] < 0.7 * error[0]


def test_options_of_another_function_are_named(scenes):
    world = durer.load(scenes / "sphere.txt")
    with pytest.raises(TypeError, match="did you mean samples"):
        world.render(sample=4)
    with pytest.raises(TypeError, match="option of durer.load"):
        world.render(dialect="f04")
    with pytest.raises(TypeError, match="durer.options"):
        world.render(zzz=4)


def test_display_options_of_files(scenes, tmp_path):
    pictures = durer.load(scenes / "sphere.txt").render(size=(16, 16), samples=4)
    pictures.save(tmp_path / "a.png")
    pictures.save(tmp_path / "b.png", exposure=1)
    dark, bright = durer.read(tmp_path / "a.png")[0], durer.read(tmp_path / "b.png")[0]
    assert bright.mean() > 1.2 * dark.mean()
    with pytest.raises(ValueError, match="tone must be one of"):
        pictures.save(tmp_path / "c.png", tone="film")
    with pytest.raises(ValueError, match="bits"):
        pictures.save(tmp_path / "c.png", bits=12)
