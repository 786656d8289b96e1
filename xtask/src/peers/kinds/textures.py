"""Pictures on surfaces: filters, edges, encoding and transforms."""

import mitsuba_xml as x
from mitsuba_xml import ball, bitmap, bsdf, constant, floor, lamp, rectangle, shape, texture, transform
from scene import stage


def room(*parts):
    return stage(constant(0.5), floor(), lamp(), *parts)


def card(reflectance, at=(0, 0.85, 0), turn=("rotate", (0, 1, 0), 20), size=(1.2, 0.8)):
    return rectangle(bsdf("diffuse", reflectance=reflectance), size=size, turn=[turn], at=at)


def uv(*steps):
    return transform(*steps, name="to_uv")


def scenes():
    colors = lambda *parts, **more: card(bitmap("colors.png", *parts, **more))
    yield "bilinear", room(colors())
    yield "nearest", room(colors(filter_type="nearest"))
    yield "raw", room(colors(raw=True))
    for mode in ("repeat", "mirror", "clamp"):
        yield f"{mode}", room(colors(uv(("scale", (2.5, 1.7, 1)), ("translate", (0.3, -0.4, 0))), wrap_mode=mode))
    yield "turned coordinates", room(colors(uv(("rotate", (0, 0, 1), 30), ("scale", (1.5, 1, 1)))))
    yield "linear picture", room(card(bitmap("normals.exr")))
    yield "grey bytes", room(card(bitmap("grey.png")))
    yield "checkerboard", room(card(texture("checkerboard", uv(("scale", (4, 3, 1))), color0=(0.8, 0.2, 0.1), color1=(0.1, 0.3, 0.6))))
    picture = bsdf("diffuse", reflectance=bitmap("colors.png"))
    yield "sphere and cube", room(ball(picture, x=-0.75), shape("cube", picture, transform(
        ("scale", (0.4, 0.4, 0.4)), ("rotate", (0, 1, 0), 30), ("translate", (0.75, 0.4, 0)))))
    yield "disk and cylinder", room(shape("disk", picture, transform(("scale", (0.6, 0.6, 1)), ("translate", (-0.75, 0.7, 0)))), shape(
        "cylinder", bsdf("twosided", picture), p0=x.Point((0.7, 0, 0)), p1=x.Point((0.9, 1.1, 0)), radius=0.4))
    yield "OBJ and PLY", room(shape("obj", picture, transform(("scale", (0.6,) * 3), ("translate", (-0.75, 0.6, 0))), filename="ball.obj"), shape(
        "ply", picture, transform(("scale", (0.6,) * 3), ("translate", (0.75, 0.6, 0))), filename="ball.ply"))
    yield "flip_tex_coords", room(
        shape("obj", picture, transform(("scale", (0.6,) * 3), ("translate", (-0.75, 0.6, 0))), filename="ball.obj", flip_tex_coords=False),
        shape("ply", picture, transform(("scale", (0.6,) * 3), ("translate", (0.75, 0.6, 0))), filename="ball.ply", flip_tex_coords=True))
