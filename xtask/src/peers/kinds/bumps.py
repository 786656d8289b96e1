"""Bump maps and normal maps."""

import mitsuba_xml as x
from mitsuba_xml import ball, bitmap, bsdf, constant, diffuse, floor, lamp, rectangle, shape, transform
from scene import stage


def room(*parts):
    return stage(constant(0.25), floor(), lamp(), *parts)


def card(material, x_=0.0):
    return rectangle(material, size=(0.6, 0.6), turn=[("rotate", (1, 0, 0), -40), ("rotate", (0, 1, 0), 15)], at=(x_, 0.7, 0))


def bump(inner=None, file="bumps.exr", **more):
    return bsdf("bumpmap", bitmap(file, raw=True), inner or diffuse(0.6), **more)


def normal(inner=None, file="normals.exr"):
    return bsdf("normalmap", inner or diffuse(0.6), normalmap=bitmap(file, raw=True))


def mesh(material, x_, kind="ply"):
    return shape(kind, material, transform(("scale", (0.6,) * 3), ("rotate", (1, 0, 0), -90), ("translate", (x_, 0.6, 0))), filename=f"ball.{kind}")


def scenes():
    metal = bsdf("roughconductor", distribution="ggx", material="Al", alpha=0.2)
    yield "bumps on cards", room(card(bump(scale=0.05), -0.75), card(bump(scale=0.15), 0.75))
    yield "bumps from bytes", room(card(bump(scale=0.05, file="bumps.png"), 0))
    yield "bumps on a sphere", room(ball(bump(scale=0.05), x=-0.75), ball(bump(metal, scale=0.02), x=0.75))
    yield "bumps on a mesh", room(mesh(bump(scale=0.05), -0.75), mesh(bump(scale=0.05), 0.75, "obj"))
    yield "bumps on metal and plastic", room(card(bump(metal, scale=0.05), -0.75), card(bump(bsdf("plastic"), scale=0.05), 0.75))
    yield "normals on cards", room(card(normal(), -0.75), card(normal(metal), 0.75))
    yield "normals from bytes", room(card(normal(file="normals.png")))
    yield "normals on a mesh", room(mesh(normal(), -0.75), mesh(normal(metal), 0.75, "obj"))
    yield "twosided bumps", room(card(bsdf("twosided", bump(scale=0.08)), -0.75), rectangle(
        bsdf("twosided", bump(scale=0.08)), size=(0.6, 0.6), turn=[("rotate", (1, 0, 0), 140)], at=(0.75, 0.7, 0)))
