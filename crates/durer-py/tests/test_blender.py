"""The parts of the add-on for Blender that need no Blender: `packaging/blender`."""

import importlib
import math
import sys
import types
from pathlib import Path

import numpy as np
import pytest

import durer

FOLDER = Path(__file__).parents[3] / "packaging/blender/durer_blender"


@pytest.fixture(scope="module")
def addon():
    """Returns a function that imports a module of the add-on, without its `__init__`, which needs
    Blender."""
    package = types.ModuleType("durer_addon")
    package.__path__ = [str(FOLDER)]
    sys.modules["durer_addon"] = package
    yield lambda name: importlib.import_module(f"durer_addon.{name}")
    for name in [name for name in sys.modules if name.partition(".")[0] == "durer_addon"]:
        del sys.modules[name]


def brightness(units, lights="", emitter="", samples=256):
    """Returns the radiance of a white matte floor at the origin of Blender."""
    camera = units.block("OrthographicCamera", [("center", units.point((0, -2, 2))), ("direction", units.point((0, 1, -1))), ("up", (0, 1, 0)), ("size", 0.01)])
    floor = "MaterialIndex 0 " + units.placed(np.eye(4), "Rectangle { corner -50 -50 0 edge0 100 0 0 edge1 0 100 0 }")
    text = f"""{camera}
        Background {{ color 0 0 0 }}
        Lights {{ {lights} }}
        Materials {{
            PrincipledMaterial {{ baseColor 1 1 1 specularWeight 0 }}
            PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 1 seenByCamera off }}
        }}
        Group {{ {floor} {emitter} }}"""
    pictures = durer.World.from_text(text, dialect="durer").render(size=(4, 4), samples=samples, integrator="path", bounces=1)
    return float(pictures["color"].mean())


def test_lights_have_the_power_that_blender_gives_them(addon):
    units, watts, height = addon("units"), 50.0, 2.0
    # A white surface reflects the irradiance divided by pi; that of a point is its intensity over the
    # squared distance, and that of a disc pi times its radiance times the squared sine.
    point = units.block("PointLight", [("position", units.point((0, 0, height))), ("color", (units.point_strength(watts),) * 3), ("attenuation", (0, 0, 1))])
    expected = watts / (4 * math.pi) / height**2 / math.pi
    assert brightness(units, point, samples=1) == pytest.approx(expected, rel=1e-5)
    sun = units.block("DirectionalLight", [("direction", units.point((0, 0, -1))), ("color", (units.sun_strength(3),) * 3)])
    assert brightness(units, sun, samples=1) == pytest.approx(3 / math.pi, rel=1e-5)
    sphere = "MaterialIndex 1 " + units.block("Sphere", [("center", units.point((0, 0, height))), ("radius", 0.5)])
    assert units.sphere_radiance(watts, 0.5) * brightness(units, emitter=sphere) == pytest.approx(expected, rel=0.01)
    disc = "MaterialIndex 1 " + units.block("Disc", [("center", units.point((0, 0, height))), ("normal", units.point((0, 0, -1))), ("radius", 1)])
    expected = watts / math.pi**2 / (1 + height**2)
    assert units.area_radiance(watts, math.pi) * brightness(units, emitter=disc) == pytest.approx(expected, rel=0.01)


def test_spotlights_and_points_in_discs(addon):
    units = addon("units")
    edge, inner = units.spot_angles(math.radians(90), 0.5)
    assert edge == pytest.approx(45)
    assert math.cos(math.radians(inner)) == pytest.approx((1 + math.cos(math.radians(45))) / 2)
    assert units.spot_angles(1, 0)[1] == pytest.approx(units.spot_angles(1, 0)[0])
    points = units.disc_points(64)
    assert np.abs(points.mean(0)).max() < 0.02
    assert (points**2).sum(1).mean() == pytest.approx(0.5, abs=1e-6)


def test_fields_of_view(addon):
    units = addon("units")
    whole = math.degrees(2 * math.atan(18 / 50))
    assert units.view_angle(50, 36, 200, 100, "AUTO") == pytest.approx(whole)
    assert units.view_angle(50, 36, 100, 200, "AUTO") == pytest.approx(whole)
    assert units.view_angle(50, 36, 100, 200, "HORIZONTAL") == pytest.approx(math.degrees(2 * math.atan(2 * 18 / 50)))
    assert units.view_angle(50, 24, 200, 100, "VERTICAL") == pytest.approx(math.degrees(2 * math.atan(2 * 12 / 50)))
    assert units.film_shift(0.1, 200, 100, "AUTO") == pytest.approx(0.2)
    assert units.film_shift(0.1, 200, 100, "VERTICAL") == pytest.approx(0.1)


def test_numbers_that_are_not_finite_are_refused(addon):
    units = addon("units")
    with pytest.raises(units.ExportError, match="nan"):
        units.block("Sphere", [("radius", math.nan)])
    with pytest.raises(units.ExportError, match="1e\\+300"):
        units.block("Sphere", [("radius", 1e300)])
    assert units.block("A", [("a", 0.5), ("b", None), ("c", (1, 2)), ("d", [[1, 2], [3, 4]])]) == "A { a 0.5 c 1 2 d { 1 2  3 4 } }"


def test_pictures_are_read_by_durer(addon, tmp_path):
    pixels = addon("pixels")
    values = np.random.default_rng(1).random((5, 7, 3), np.float32)
    (tmp_path / "a.pfm").write_bytes(pixels.pfm(values))
    assert (durer.read(tmp_path / "a.pfm")[0] == values).all()
    eight = np.rint(values * 255).astype(np.uint8)
    (tmp_path / "a.png").write_bytes(pixels.png(eight))
    read, display = durer.read(tmp_path / "a.png")
    assert display and np.allclose(read * 255, eight, atol=1e-3)
    textures = pixels.Textures()
    assert textures.file(eight / np.float32(255), True).endswith(".png")
    assert textures.file(values, True).endswith(".pfm")
    names = [textures.add("a.png", (("wrapU", wrap),)) for wrap in ("repeat", "clamp", "repeat")]
    assert names == ["texture0", "texture1", "texture0"]


def test_corners_of_meshes_are_joined_if_all_columns_agree(addon):
    meshes = addon("meshes")
    places = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 0), (1, 0, 0), (0, 1, 0)], np.float32)
    uvs = np.array([(0, 0), (1, 0), (0, 1), (0, 0), (1, 0), (0, 0.5)], np.float32)
    first, vertex = meshes.join([(("x", "y", "z"), places), (("u", "v"), uvs)])
    assert len(first) == 4
    assert (places[first][vertex] == places).all() and (uvs[first][vertex] == uvs).all()
    content = meshes.ply([(("x", "y", "z"), places[:3])], np.array([(0, 1, 2)]), True)
    world = durer.World.from_text(
        "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 } Group { TriangleMesh { obj_file a.ply } }", files={"a.ply": content}
    )
    assert world.closest((0.2, 0.2, 5), (0, 0, -1)).t == 5


def test_nodes_on_pictures(addon):
    nodes, units = addon("nodes"), addon("units")
    picture = nodes.Field(np.ones((2, 4, 4), np.float32), nodes.Mapping())
    other = nodes.Field(np.full((4, 2, 4), 2, np.float32), nodes.Mapping())
    assert nodes.combine(np.multiply, picture, other).values.shape == (4, 4, 4)
    assert nodes.combine(np.multiply, nodes.constant(3), nodes.constant((1, 2, 3, 1))).is_constant
    with pytest.raises(nodes.Untranslated, match="different mappings"):
        nodes.combine(np.add, picture, nodes.Field(other.values, nodes.Mapping(wrap="clamp")))
    half, one = nodes.constant(0.5).values, nodes.constant(1).values
    color = nodes.constant((0.8, 0.4, 0.2, 1)).values
    assert np.allclose(nodes._hue_saturation(half, one, one, one, color), color)
    assert np.allclose(nodes._hue_saturation(half, 0 * one, one, one, color)[:3], 0.8)
    turned = nodes._hue_saturation(half + np.float32(1 / 3), one, one, one, color)
    assert np.allclose(turned[:3], (0.2, 0.8, 0.4), atol=1e-6)
    assert units.luminance(units.black_body(6500)) == pytest.approx(1, abs=1e-3)
    warm = units.black_body(2700)
    assert warm[0] > warm[1] > warm[2]
    assert units.metal_edge((1, 1, 1)) == pytest.approx([1, 1, 1])


def test_messages_are_reported_once(addon):
    report = addon("report").Report()
    for number in [0, 0, *range(25)]:
        report.add(f"message {number}")
    assert report.lines(20)[0] == "message 0"
    assert report.lines(20)[-1] == "and 5 more such messages"
