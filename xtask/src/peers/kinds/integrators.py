"""What `max_depth`, `hide_emitters` and `rr_depth` mean, for `path`, `volpath` and `direct`."""

import mitsuba_xml as x
from mitsuba_xml import area, ball, bsdf, constant, diffuse, floor, lamp, rectangle, shape, transform, two_balls
from scene import stage

BALLS = two_balls(diffuse(0.7, 0.4, 0.3), bsdf("dielectric"))


def room(*parts, kind="path", **more):
    wall = rectangle(diffuse(0.6, 0.6, 0.7), size=(4, 3), at=(0, 1.5, -1.5))
    return stage(floor(), wall, lamp(), constant(0.2), *parts, integrator=x.plugin("integrator", kind, **more))


# After a hidden emitter, Mitsuba measures the next hit from the emitter, but shades it as if it were measured from the camera.
# Spheres and rectangles behind it are shaded at wrong points; meshes, whose points come from their corners, are not.
HIDDEN = dict(mitsuba_is_wrong="spheres behind a hidden emitter are shaded at a wrong point; if all is made of meshes, both agree")


def ball_mesh(material, x_):
    return shape("ply", material, transform(("scale", (0.6,) * 3), ("rotate", (1, 0, 0), -90), ("translate", (x_, 0.6, 0))), filename="ball.ply")


def mesh_room(*parts, kind="path", **more):
    slab = lambda color, scale, at: shape("cube", diffuse(*color), transform(("scale", scale), ("translate", at)))
    sides = slab((0.4, 0.35, 0.3), (4, 0.1, 4), (0, -0.1, 0)) + slab((0.6, 0.6, 0.7), (4, 3, 0.1), (0, 1.5, -1.6))
    balls = ball_mesh(diffuse(0.7, 0.4, 0.3), -0.75) + ball_mesh(diffuse(0.3, 0.6, 0.4), 0.75)
    return stage(sides, lamp(), constant(0.2), balls, *parts, integrator=x.plugin("integrator", kind, hide_emitters=True, **more))


def scenes():
    shining = ball(area(1, 1.5, 2), radius=0.4, y=0.4, z=1.0)
    for depth in (1, 2, 3, 4):
        yield f"path, depth {depth}", room(BALLS, shining, max_depth=depth)
    yield "path, depth 0", room(BALLS, shining, max_depth=0), dict(warns=("the picture is completely black", "paths end at the first surface"))
    yield "volpath, depth 2", room(BALLS, shining, kind="volpath", max_depth=2)
    yield "volpath, depth 3", room(BALLS, shining, kind="volpath", max_depth=3)
    yield "unlimited", room(BALLS)
    yield "rr_depth 2", room(BALLS, rr_depth=2, max_depth=20)
    yield "direct", room(BALLS, shining, kind="direct")
    panel = rectangle(area(2, 1, 1), size=(0.5, 0.4), at=(0, 1.2, 0.5))
    yield "hide_emitters, path", room(BALLS, shining, hide_emitters=True, max_depth=6), HIDDEN
    yield "hide_emitters, path, meshes", mesh_room(shining, max_depth=6)
    yield "hide_emitters, constant", stage(constant(0.5), BALLS, integrator=x.integrator(hide_emitters=True))
    yield "hide_emitters, seen in a mirror", room(ball(bsdf("conductor"), x=-0.75), shining, hide_emitters=True, max_depth=6), HIDDEN
    yield "hide_emitters, direct", room(BALLS, shining, kind="direct", hide_emitters=True), HIDDEN
    yield "hide_emitters, direct, meshes", mesh_room(shining, kind="direct")
    yield "hide_emitters, panel before a wall", room(BALLS, panel, hide_emitters=True, max_depth=6), HIDDEN
    yield "hide_emitters, panel before meshes", mesh_room(panel, max_depth=6)
