"""Lights without extent, and lights that project pictures."""

import mitsuba_xml as x
from mitsuba_xml import Point, bitmap, bsdf, diffuse, emitter, floor, rectangle, transform, two_balls
from scene import stage


def room(*lights):
    wall = rectangle(diffuse(0.5), size=(4, 3), at=(0, 1.5, -1.5))
    return stage(floor(), wall, two_balls(diffuse(0.7, 0.4, 0.3), bsdf("plastic")), *lights)


ABOVE = transform(("lookat", (0.5, 3, 2), (0, 0.3, 0)))


def spot(*parts, **more):
    return emitter("spot", ABOVE, *parts, intensity=(30.0, 25.0, 20.0), **more)


def scenes():
    yield "point", room(emitter("point", position=Point((0.5, 3, 2)), intensity=(12.0, 10.0, 8.0)))
    yield "point by transform", room(emitter("point", transform(("translate", (-1, 2, 2))), intensity=8.0))
    yield "three points", room(*(emitter("point", position=Point((x_, 2.5, 2)), intensity=c) for x_, c in (
        (-2, (6.0, 0.5, 0.5)), (0, (0.5, 6.0, 0.5)), (2, (0.5, 0.5, 6.0)))))
    yield "spot", room(spot())
    yield "spot, wide", room(spot(cutoff_angle=50.0, beam_width=10.0))
    yield "spot, hard", room(spot(cutoff_angle=25.0, beam_width=25.0))
    yield "spot, narrow beam", room(spot(cutoff_angle=15.0, beam_width=14.0))
    yield "spot with a texture", room(spot(x.value("texture", bitmap("colors.png")), cutoff_angle=30.0))
    yield "directional", room(emitter("directional", direction=Point((-1, -2, -1.5)), irradiance=(2.0, 1.8, 1.5)))
    yield "directional by transform", room(emitter("directional", transform(("rotate", (1, 0, 0), 120), ("rotate", (0, 1, 0), 40)), irradiance=2.0))
    yield "directionalarea", room(rectangle(emitter("directionalarea", radiance=(8.0, 7.0, 6.0)), size=(0.8, 0.8), turn=[x.DOWN], at=(0, 3, 0)), x.constant(0.1)), dict(
        warns=("the light `directionalarea` of a shape has no counterpart",), differs="no counterpart")
    projector = lambda *parts, **more: emitter("projector", ABOVE, x.value("irradiance", bitmap("colors.png")), *parts, **more)
    yield "projector", room(projector(fov=40.0, scale=20.0))
    yield "projector across y", room(projector(fov=30.0, fov_axis="y", scale=20.0))
    yield "scaled spot", room(emitter("spot", transform(("scale", (2, 2, 2)), ("lookat", (0.5, 3, 2), (0, 0.3, 0))), intensity=20.0))
