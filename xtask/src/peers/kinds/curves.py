"""Curves and hair."""

import mitsuba_xml as x
from mitsuba_xml import bsdf, constant, diffuse, floor, lamp, shape
from scene import stage


def room(*parts):
    return stage(constant(0.4, 0.45, 0.5), floor(), lamp(), *parts)


def spline(material, **more):
    return shape("bsplinecurve", material, filename="curves.txt", **more)


def scenes():
    yield "splines", room(spline(diffuse(0.7, 0.4, 0.2)))
    yield "splines of metal", room(spline(bsdf("roughconductor", distribution="ggx", material="Au", alpha=0.3)))
    yield "straight pieces", room(shape("linearcurve", diffuse(0.7, 0.4, 0.2), filename="curves.txt"))
    yield "stick with joints", room(shape("linearcurve", diffuse(0.7, 0.4, 0.2), filename="stick.txt"))
    yield "scaled splines", room(spline(diffuse(0.7, 0.4, 0.2) + x.transform(("scale", (0.8, 0.8, 0.8)), ("rotate", (0, 1, 0), 20), ("translate", (0, 0.1, 0)))))
    yield "brown hair", room(spline(bsdf("hair", eumelanin=0.4, pheomelanin=0.3)))
    yield "hair by absorption", room(spline(bsdf("hair", sigma_a=(0.2, 0.5, 1.0), longitudinal_roughness=0.3, azimuthal_roughness=0.4)))
    yield "hair without tilt", room(spline(bsdf("hair", eumelanin=0.2, scale_tilt=0.0, longitudinal_roughness=0.5)))
