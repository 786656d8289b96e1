"""Meshes from files, their normals and colours, groups and instances."""

import mitsuba_xml as x
from mitsuba_xml import ball, bsdf, constant, diffuse, floor, lamp, plugin, shape, texture, transform
from scene import stage

RED = diffuse(0.7, 0.2, 0.1)
VERTEX_COLOR = x.value("name", "vertex_color")


def room(*parts):
    return stage(constant(0.3, 0.35, 0.4), floor(), lamp(), *parts)


def mesh(file, material=RED, x_=0.0, scale=(0.6, 0.6, 0.6), **more):
    return shape(file.split(".")[-1], material, transform(("scale", scale), ("rotate", (1, 0, 0), -70), ("translate", (x_, 0.65, 0))), filename=file, **more)


def group(name, *parts):
    return plugin("shape", "shapegroup", *parts).replace('type="shapegroup"', f'type="shapegroup" id="{name}"', 1)


def instance(name, *steps):
    return shape("instance", f'<ref id="{name}"/>', transform(*steps))


def scenes():
    colors = bsdf("diffuse", reflectance=texture("mesh_attribute", VERTEX_COLOR))
    yield "smooth and flat", room(mesh("ball.ply", x_=-0.75), mesh("ball.ply", x_=0.75, face_normals=True))
    yield "without normals", room(mesh("bare-ball.ply", x_=-0.75), mesh("block.ply", x_=0.75, scale=(0.4,) * 3))
    yield "OBJ", room(mesh("ball.obj", x_=-0.75), mesh("wave.obj", bsdf("twosided", RED), x_=0.75))
    yield "unequal and mirroring scales", room(mesh("ball.ply", x_=-0.75, scale=(0.6, 0.3, 0.8)), mesh("ball.ply", x_=0.75, scale=(-0.6, 0.5, 0.4)))
    yield "flipped normals", room(mesh("ball.ply", x_=-0.75, flip_normals=True), mesh("bare-ball.ply", bsdf("twosided", RED), x_=0.75, flip_normals=True))
    yield "smooth metal and glass", room(
        mesh("ball.ply", bsdf("roughconductor", distribution="ggx", material="Au", alpha=0.2), x_=-0.75), mesh("ball.ply", bsdf("dielectric"), x_=0.75))
    yield "flat glass", room(mesh("block.ply", bsdf("dielectric"), scale=(0.5, 0.4, 0.6), face_normals=True))
    yield "colours of vertices", room(mesh("colored-ball.ply", colors))
    yield "scaled colours of vertices", room(mesh("colored-ball.ply", bsdf("diffuse", reflectance=texture(
        "mesh_attribute", VERTEX_COLOR, scale=0.5))))
    pair = group("pair", ball(RED, radius=0.3, y=0.3), shape("cube", bsdf("roughconductor", distribution="ggx", material="Cu", alpha=0.3), transform(
        ("scale", (0.2, 0.2, 0.2)), ("translate", (0.4, 0.2, 0.2)))))
    yield "instances", room(pair, instance("pair", ("translate", (-0.8, 0, 0))), instance("pair", ("rotate", (0, 1, 0), 120), ("translate", (0.7, 0.1, 0))))
    yield "scaled instances", room(pair, instance("pair", ("scale", (1.5, 0.7, 1)), ("translate", (-0.8, 0, 0))), instance(
        "pair", ("scale", (-1, 1, 1)), ("translate", (0.8, 0, 0.3))))
    meshes = group("meshes", shape("ply", RED, transform(("scale", (0.4,) * 3), ("translate", (0, 0.4, 0))), filename="ball.ply"))
    yield "instances of a mesh", room(meshes, *(instance("meshes", ("translate", (-1.2 + 0.8 * i, 0.1 * i, 0))) for i in range(4)))
    yield "merge", room(shape("merge", mesh("ball.ply", x_=-0.75), mesh("block.ply", x_=0.75, scale=(0.4,) * 3)))
    yield "cubes and cylinders", room(
        shape("cube", RED, transform(("scale", (0.4, 0.5, 0.3)), ("rotate", (0, 1, 0), 40), ("translate", (-0.75, 0.5, 0)))),
        shape("cylinder", RED, p0=x.Point((0.75, 0, 0)), p1=x.Point((0.85, 1.1, 0.2)), radius=0.35))
