"""Fronts and backs of surfaces: which of them reflect and emit."""

import mitsuba_xml as x
from mitsuba_xml import area, ball, bsdf, constant, diffuse, floor, lamp, rectangle, shape, transform
from scene import stage

RED, BLUE = diffuse(0.7, 0.2, 0.1), diffuse(0.1, 0.3, 0.8)
FRONT, BACK = ("rotate", (0, 1, 0), 30), ("rotate", (0, 1, 0), 200)


def two_cards(material, **more):
    card = lambda turn, at: rectangle(material, size=(0.6, 0.7), turn=[turn], at=at, **more)
    return card(FRONT, (-0.7, 0.75, 0)) + card(BACK, (0.7, 0.75, 0))


def room(*parts):
    return stage(constant(0.3, 0.35, 0.4), floor(), lamp(), *parts)


def scenes():
    yield "one-sided matte", room(two_cards(RED))
    yield "twosided", room(two_cards(bsdf("twosided", RED)))
    yield "twosided with two materials", room(two_cards(bsdf("twosided", RED, BLUE)))
    yield "twosided, smooth and rough", room(two_cards(bsdf(
        "twosided", bsdf("roughconductor", distribution="ggx", material="Au", alpha=0.2), bsdf("plastic"))))
    yield "one-sided metal and plastic", room(two_cards(bsdf("roughconductor", distribution="ggx", material="Cu", alpha=0.2)))
    yield "flipped normals", room(two_cards(RED, flip_normals=True))
    yield "flipped twosided", room(two_cards(bsdf("twosided", RED, BLUE), flip_normals=True))
    yield "one-sided emission", room(rectangle(area(2, 1, 0.5), size=(0.5, 0.6), turn=[FRONT], at=(-0.8, 0.8, 0)),
                                     rectangle(area(0.5, 1, 2), size=(0.5, 0.6), turn=[BACK], at=(0.8, 0.8, 0)))
    yield "flipped emission", room(rectangle(area(2, 1, 0.5), size=(0.5, 0.6), turn=[FRONT], at=(-0.8, 0.8, 0), flip_normals=True),
                                   rectangle(area(0.5, 1, 2), size=(0.5, 0.6), turn=[BACK], at=(0.8, 0.8, 0), flip_normals=True))
    yield "emission and reflection", room(ball(area(0.5, 0.4, 0.3), diffuse(0.6), x=-0.75), ball(
        area(0.1, 0.2, 0.4), bsdf("roughconductor", distribution="ggx", material="Al", alpha=0.3), x=0.75))
    yield "inside a matte sphere", stage(shape("sphere", diffuse(0.6, 0.5, 0.4), radius=6.0, flip_normals=True), lamp(), ball(RED), floor())
    yield "inside a shining sphere", stage(shape("sphere", area(0.6, 0.5, 0.4), radius=6.0, flip_normals=True), ball(RED), floor())
    yield "shining sphere seen from outside", room(ball(area(1, 2, 1), x=-0.75, flip_normals=True), ball(RED, x=0.75))
    yield "mirrored sphere", room(shape("sphere", RED, transform(("scale", (-0.6, 0.6, 0.6)), ("translate", (-0.75, 0.6, 0)))),
                                  shape("sphere", area(2, 1, 1), transform(("scale", (0.6, -0.6, 0.6)), ("translate", (0.75, 0.6, 0)))))
    yield "glass sphere with flipped normals", room(ball(bsdf("dielectric"), flip_normals=True))
    yield "matte sphere with flipped normals", room(ball(RED, x=-0.75, flip_normals=True), ball(bsdf("twosided", RED, BLUE), x=0.75, flip_normals=True))
    yield "no material", room(ball(x=-0.75), shape("cube", transform(("scale", (0.4, 0.4, 0.4)), ("rotate", (0, 1, 0), 30), ("translate", (0.75, 0.4, 0)))))
