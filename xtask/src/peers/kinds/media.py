"""Participating media: absorbing, scattering, and with a density from a grid."""

import mitsuba_xml as x
from mitsuba_xml import ball, bsdf, constant, diffuse, floor, lamp, medium, phase, rectangle, shape, transform, two_balls, volume
from scene import stage


def inside(*parts, **more):
    """Returns a homogeneous medium as the interior of a shape."""
    return medium("homogeneous", *parts, **more).replace("<medium", '<medium name="interior"', 1)


def hg(g):
    return phase("hg", g=g)


def room(*parts, depth=80, light=None):
    return stage(light or constant(0.5, 0.55, 0.6), floor(), *parts, integrator=x.integrator("volpath", depth))


def cloud(material, medium_, x_=0.0):
    return ball(material, medium_, x=x_)


NULL, GLASS = bsdf("null"), bsdf("dielectric", int_ior=1.4)


def scenes():
    smoke = inside(sigma_t=2.0, albedo=0.0)
    mist = inside(sigma_t=3.0, albedo=(0.9, 0.8, 0.6))
    yield "absorbing", room(cloud(NULL, smoke, -0.75), cloud(NULL, inside(sigma_t=(0.1, 0.3, 0.6), scale=5.0, albedo=0.0), 0.75))
    yield "absorbing glass", room(lamp(), cloud(GLASS, smoke, -0.75), cloud(GLASS, inside(sigma_t=(0.1, 0.3, 0.6), scale=5.0, albedo=0.0), 0.75))
    yield "scattering", room(cloud(NULL, mist, -0.75), cloud(NULL, inside(hg(0.7), sigma_t=4.0, albedo=0.95), 0.75))
    yield "scattering backwards", room(cloud(NULL, inside(hg(-0.5), sigma_t=3.0, albedo=0.9), -0.75), cloud(NULL, inside(hg(0.3), sigma_t=3.0, albedo=0.8), 0.75))
    yield "colours of extinction", room(cloud(NULL, inside(sigma_t=(0.25, 0.5, 1.0), scale=4.0, albedo=(0.9, 0.7, 0.5))))
    yield "scale", room(cloud(NULL, inside(sigma_t=0.5, albedo=0.8, scale=5.0)))
    yield "milky glass", room(cloud(GLASS, inside(sigma_t=4.0, albedo=(0.9, 0.85, 0.7))), depth=200)
    yield "rough milky glass", room(cloud(bsdf("roughdielectric", distribution="ggx", alpha=0.2, int_ior=1.4), inside(hg(0.5), sigma_t=2.0, albedo=0.8)), depth=200)
    yield "box of smoke around a ball", room(shape("cube", NULL, mist, transform(("scale", (0.9, 0.7, 0.7)), ("translate", (0, 0.75, 0)))), ball(diffuse(0.7, 0.2, 0.1), radius=0.4))
    yield "lit by a lamp", room(lamp(), cloud(NULL, mist), light=constant(0.1))
    yield "lit by a point", room(x.emitter("point", position=x.Point((0.5, 2.5, 1.5)), intensity=6.0), cloud(NULL, mist), light=constant(0.1))
    for depth in (2, 3, 5):
        yield f"depth {depth}", room(cloud(NULL, mist), depth=depth)
    grid = lambda scale, albedo, *parts: medium(
        "heterogeneous", *parts, sigma_t=volume("gridvolume", transform(("translate", (-0.5,) * 3), ("scale", (1.2,) * 3), ("translate", (0, 0.75, 0))), filename="density.vol"),
        albedo=albedo, scale=scale).replace("<medium", '<medium name="interior"', 1)
    box = lambda inner: shape("cube", NULL, inner, transform(("scale", (0.6,) * 3), ("translate", (0, 0.75, 0))))
    yield "grid, absorbing", room(box(grid(2.0, 0.0)))
    yield "grid, scattering", room(box(grid(3.0, (0.9, 0.8, 0.6))))
    yield "grid, hg", room(box(grid(4.0, 0.9, hg(0.6))))
