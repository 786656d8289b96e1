"""Light from infinitely far away: constant, and pictures of few texels under rotations."""

import mitsuba_xml as x
from mitsuba_xml import bsdf, constant, diffuse, emitter, floor, transform, two_balls
from scene import stage


def room(light):
    metal = bsdf("roughconductor", distribution="ggx", material="Ag", alpha=0.1)
    return stage(floor(), two_balls(diffuse(0.7, 0.4, 0.3), metal), light)


def sky(*steps, file="sky16.exr", **more):
    return emitter("envmap", transform(*steps) if steps else "", filename=file, **more)


def scenes():
    yield "constant", room(constant(0.8, 0.9, 1.0))
    yield "8 x 16 texels", room(sky())
    yield "turned about y", room(sky(("rotate", (0, 1, 0), 100)))
    yield "turned about x", room(sky(("rotate", (1, 0, 0), 90)))
    yield "turned about a diagonal", room(sky(("rotate", (0.6, 0, 0.8), 77)))
    yield "mirrored", room(sky(("scale", (-1, 1, 1)), ("rotate", (0, 1, 0), 30)))
    yield "scaled values", room(sky(scale=2.5))
    yield "32 x 64 texels", room(sky(file="sky64.exr"))
    yield "32 x 64 texels, turned", room(sky(("rotate", (0, 0, 1), 40), ("rotate", (0, 1, 0), -60), file="sky64.exr"))
    yield "bytes", room(sky(file="colors.png"))
    yield "seen alone", stage(sky(("rotate", (0, 1, 0), 20))), dict(warns=("the file has no visible shapes",))
