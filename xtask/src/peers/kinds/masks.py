"""Opacity, blends and surfaces that are not there."""

import mitsuba_xml as x
from mitsuba_xml import ball, bitmap, bsdf, constant, diffuse, floor, lamp, rectangle, texture, transform, two_balls
from scene import stage

METAL = bsdf("roughconductor", distribution="ggx", material="Al", alpha=0.2)


def room(*parts):
    return stage(constant(0.5, 0.55, 0.6), floor(), *parts)


def card(material, at=(0, 0.8, 0.4)):
    return rectangle(material, size=(1.0, 0.7), at=at)


def scenes():
    behind = ball(diffuse(0.7, 0.2, 0.1), z=-0.8)
    yield "even opacity", room(behind, card(bsdf("mask", diffuse(0.2, 0.5, 0.7), opacity=0.4)))
    yield "texture of opacity", room(behind, card(bsdf("mask", bsdf("twosided", diffuse(0.2, 0.5, 0.7)), opacity=bitmap("grey.png", raw=True))))
    yield "checkered opacity", room(behind, card(bsdf("mask", diffuse(0.2, 0.5, 0.7), opacity=texture(
        "checkerboard", transform(("scale", (4, 3, 1)), name="to_uv"), color0=0.0, color1=1.0))))
    yield "masked metal", room(two_balls(bsdf("mask", METAL, opacity=0.6), bsdf("mask", bsdf("plastic"), opacity=0.3)))
    yield "null", room(behind, card(bsdf("mask", diffuse(0.5), opacity=0.0)), ball(bsdf("null"), x=0.8)), dict(
        differs="Dürer does not count crossings of `null` and `mask` surfaces as scattering; at a depth of 40, both agree")
    yield "blend of mattes", room(lamp(), two_balls(
        bsdf("blendbsdf", diffuse(0.8, 0.2, 0.1), diffuse(0.1, 0.2, 0.8), weight=0.3),
        bsdf("blendbsdf", diffuse(0.8, 0.2, 0.1), diffuse(0.1, 0.2, 0.8), weight=bitmap("grey.png", raw=True))))
    yield "blend of matte and rough metal", room(lamp(), two_balls(
        bsdf("blendbsdf", diffuse(0.8, 0.2, 0.1), METAL, weight=0.3), bsdf("blendbsdf", METAL, diffuse(0.8, 0.2, 0.1), weight=0.2)))
    yield "blend of matte and mirror", room(two_balls(
        bsdf("blendbsdf", diffuse(0.8, 0.2, 0.1), bsdf("conductor"), weight=0.3), bsdf("blendbsdf", diffuse(0.8), bsdf("conductor"), weight=0.7))), dict(
            mitsuba_is_wrong="a blend adds the density of its matte part to the probability of its mirror; a black matte part makes the mirror brighter")
    half = bsdf("blendbsdf", diffuse(0.2, 0.5, 0.7), bsdf("null"), weight=0.5)
    yield "blend with null", room(behind, rectangle(half, size=(1.0, 0.7), at=(0, 0.8, 0.4)))
    yield "checkered blend", room(lamp(), card(bsdf("blendbsdf", diffuse(0.8, 0.2, 0.1), diffuse(0.1, 0.2, 0.8), weight=texture(
        "checkerboard", transform(("scale", (4, 3, 1)), name="to_uv"), color0=0.1, color1=0.9))))
