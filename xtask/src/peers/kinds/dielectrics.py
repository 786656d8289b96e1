"""Smooth, rough and thin glass, with indices inside and outside."""

from mitsuba_xml import ball, bitmap, bsdf, constant, floor, lamp, rectangle, two_balls
import mitsuba_xml as x
from scene import stage


def room(*parts, depth=12):
    return stage(constant(0.6, 0.65, 0.7), floor(), lamp(), *parts, integrator=x.integrator(max_depth=depth))


def rough(**more):
    return bsdf("roughdielectric", **({"distribution": "ggx"} | more))


def scenes():
    yield "glass and water", room(two_balls(bsdf("dielectric"), bsdf("dielectric", int_ior="water")))
    yield "diamond and ice", room(two_balls(bsdf("dielectric", int_ior="diamond"), bsdf("dielectric", int_ior=1.31)))
    yield "outside index", room(two_balls(bsdf("dielectric", int_ior=1.5, ext_ior=1.33), bsdf("dielectric", int_ior=1.0, ext_ior=1.5)))
    yield "tinted", room(two_balls(
        bsdf("dielectric", specular_transmittance=(0.9, 0.6, 0.3)), bsdf("dielectric", specular_reflectance=(0.2, 0.5, 0.9))))
    yield "ball of air in a ball of glass", room(
        ball(bsdf("dielectric", int_ior=1.5)), ball(bsdf("dielectric", int_ior=1.0, ext_ior=1.5), radius=0.4))
    yield "water in glass, by indices", room(
        ball(bsdf("dielectric", int_ior=1.5)), ball(bsdf("dielectric", int_ior=1.33, ext_ior=1.5), radius=0.4))
    yield "matte ball in glass", room(ball(bsdf("dielectric", int_ior=1.5)), ball(x.diffuse(0.7, 0.2, 0.1), radius=0.35))
    for alpha in (0.05, 0.2, 0.5):
        yield f"rough glass, alpha {alpha}", room(two_balls(rough(alpha=alpha), rough(alpha=alpha, int_ior=1.8, ext_ior=1.0)))
    yield "rough from the dense side", room(two_balls(rough(alpha=0.2, int_ior=1.0, ext_ior=1.5), rough(alpha=0.1, int_ior=1.33)))
    yield "Beckmann", room(two_balls(bsdf("roughdielectric", alpha=0.15), rough(distribution="beckmann", alpha=0.3)))
    yield "texture of alpha", room(ball(rough(alpha=bitmap("grey.png", raw=True))))
    yield "anisotropic", room(two_balls(rough(alpha_u=0.05, alpha_v=0.3), rough(alpha_u=0.3, alpha_v=0.1)))
    yield "thin panes", room(ball(x.diffuse(0.6, 0.3, 0.2), z=-0.8), rectangle(bsdf("thindielectric"), size=(0.6, 0.8), at=(-0.7, 0.8, 0.3)),
                             rectangle(bsdf("thindielectric", int_ior=2.0, specular_transmittance=(0.5, 0.8, 0.9)), size=(0.6, 0.8), at=(0.7, 0.8, 0.3)))
    # The pane is a little above the floor, because Mitsuba loses light where both touch.
    yield "thick pane", room(ball(x.diffuse(0.6, 0.3, 0.2), z=-0.8), x.shape("cube", bsdf("dielectric"), x.transform(
        ("scale", (0.8, 0.8, 0.1)), ("rotate", (0, 1, 0), 20), ("translate", (0, 0.801, 0.5)))))
    yield "depth 3", room(two_balls(bsdf("dielectric"), rough(alpha=0.1)), depth=3)
