"""Matte bases below smooth and rough dielectric boundaries."""

from mitsuba_xml import bitmap, bsdf, constant, floor, lamp, two_balls
from scene import stage


def room(first, second):
    return stage(constant(0.3, 0.35, 0.4), floor(), lamp(), two_balls(first, second))


def smooth(**more):
    return bsdf("plastic", diffuse_reflectance=(0.7, 0.3, 0.15), **more)


def rough(**more):
    return bsdf("roughplastic", **({"distribution": "ggx", "diffuse_reflectance": (0.2, 0.5, 0.8)} | more))


def scenes():
    yield "smooth", room(smooth(), smooth(int_ior=1.9))
    yield "smooth, nonlinear", room(smooth(nonlinear=True), smooth(nonlinear=True, int_ior=1.9))
    yield "specular reflectance", room(smooth(specular_reflectance=0.4), smooth(specular_reflectance=(0.9, 0.6, 0.2)))
    yield "inside water", room(smooth(ext_ior="water"), smooth(int_ior=2.4, ext_ior=1.5))
    for alpha in (0.05, 0.15, 0.3, 0.6):
        yield f"rough, alpha {alpha}", room(rough(alpha=alpha), rough(alpha=alpha, int_ior=1.9))
    for alpha in (0.1, 0.4):
        yield f"rough, nonlinear, alpha {alpha}", room(rough(alpha=alpha, nonlinear=True), rough(alpha=alpha, nonlinear=True, diffuse_reflectance=0.9))
    yield "rough Beckmann", room(bsdf("roughplastic", alpha=0.1), rough(distribution="beckmann", alpha=0.3))
    yield "textures", room(bsdf("plastic", diffuse_reflectance=bitmap("colors.png")), rough(alpha=0.2, diffuse_reflectance=bitmap("colors.png")))
