"""What `max_depth`, `hide_emitters` and `rr_depth` mean, for `path`, `volpath` and `direct`."""

import mitsuba_xml as x
from mitsuba_xml import area, ball, bsdf, constant, diffuse, floor, lamp, rectangle, two_balls
from scene import stage

BALLS = two_balls(diffuse(0.7, 0.4, 0.3), bsdf("dielectric"))


def room(*parts, kind="path", **more):
    wall = rectangle(diffuse(0.6, 0.6, 0.7), size=(4, 3), at=(0, 1.5, -1.5))
    return stage(floor(), wall, lamp(), constant(0.2), *parts, integrator=x.plugin("integrator", kind, **more))


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
    yield "hide_emitters, path", room(BALLS, shining, hide_emitters=True, max_depth=6)
    yield "hide_emitters, constant", stage(constant(0.5), BALLS, integrator=x.integrator(hide_emitters=True))
    yield "hide_emitters, seen in a mirror", room(ball(bsdf("conductor"), x=-0.75), shining, hide_emitters=True, max_depth=6)
    yield "hide_emitters, direct", room(BALLS, shining, kind="direct", hide_emitters=True)
    yield "hide_emitters, panel before a wall", room(BALLS, rectangle(area(2, 1, 1), size=(0.5, 0.4), at=(0, 1.2, 0.5)), hide_emitters=True, max_depth=6)
