"""Smooth and rough metals, which give nothing back for light scattered more than once."""

from mitsuba_xml import bsdf, constant, floor, lamp, two_balls, bitmap
from scene import stage

BECKMANN = "`beckmann` has no counterpart"


def room(first, second=None):
    return stage(constant(0.3, 0.35, 0.4), floor(), lamp(), two_balls(first, second or first))


def rough(**more):
    return bsdf("roughconductor", **({"distribution": "ggx"} | more))


def scenes():
    yield "gold and copper by name", room(bsdf("conductor", material="Au"), bsdf("conductor", material="Cu"))
    yield "aluminium and silver", room(rough(material="Al", alpha=0.1), rough(material="Ag", alpha=0.3))
    yield "chromium and tungsten", room(rough(material="Cr", alpha=0.2), rough(material="W", alpha=0.5))
    yield "TiN and a-C", room(rough(material="TiN", alpha=0.15), rough(material="a-C", alpha=0.15))
    yield "eta and k", room(bsdf("conductor", eta=(0.2, 0.9, 1.4), k=(3.9, 2.5, 1.9)), rough(alpha=0.3, eta=1.5, k=2.0))
    yield "brushed metals", room(rough(material="Au", alpha_u=0.05, alpha_v=0.3), rough(material="Al", alpha_u=0.5, alpha_v=0.1))
    yield "tinted", room(rough(material="Ag", alpha=0.2, specular_reflectance=(0.9, 0.5, 0.3)), bsdf("conductor", specular_reflectance=(0.3, 0.6, 0.9)))
    yield "very rough", room(rough(material="none", alpha=1.0), rough(material="Cu", alpha=0.8))
    yield "Beckmann by name", room(rough(material="Au", distribution="beckmann", alpha=0.3))
    yield "Beckmann by default", room(bsdf("roughconductor", material="Al", alpha=0.15))
    yield "texture of alpha", room(rough(material="Al", alpha=bitmap("grey.png", raw=True)))
    yield "texture of reflectance", room(rough(material="none", alpha=0.2, specular_reflectance=bitmap("colors.png")))
