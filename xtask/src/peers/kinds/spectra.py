"""Colours that are given as spectra. Mitsuba renders most of them only in its spectral variants, so
all surfaces are grey, and colours do not depend on how many wavelengths a path carries.
"""

import mitsuba_xml as x
from mitsuba_xml import bsdf, constant, emitter, floor, spectrum, two_balls
from scene import stage

SPECTRAL = dict(variant="scalar_spectral")
RANGE = dict(wavelength_min=400.0, wavelength_max=700.0)
NODES = "360, 450, 520, 600, 830"
GREY = x.diffuse(0.5)


def named(name, value):
    return f'<spectrum name="{name}" value="{value}"/>'


def light(color):
    """Returns a scene with one light of the colour."""
    source = emitter("area", color) if color.startswith("<spectrum name") else emitter("area", radiance=color)
    lamp = x.rectangle(source, size=(0.7, 0.7), turn=[x.DOWN], at=(0.3, 2.6, 0.8))
    return stage(floor(GREY), lamp, two_balls(GREY, bsdf("plastic")))


def matte(reflectance):
    return bsdf("diffuse", reflectance) if reflectance.startswith("<spectrum name") else bsdf("diffuse", reflectance=reflectance)


def surfaces(first, second):
    """Returns a scene in which light meets one coloured surface at most."""
    return stage(emitter("constant", radiance=spectrum("d65", scale=0.8)), two_balls(first, second), integrator=x.integrator(max_depth=2))


def scenes():
    yield "light, black body, 2800 K", light(spectrum("blackbody", temperature=2800.0)), SPECTRAL
    yield "light, black body, 3500 K", light(spectrum("blackbody", temperature=3500.0)), SPECTRAL | dict(warns=("the picture is mostly white", "there is too much light"))
    yield "light, regular", light(spectrum("regular", values="1, 2, 3, 5, 8, 7, 4", **RANGE)), SPECTRAL
    yield "light, irregular", light(spectrum("irregular", wavelengths=NODES, values="7, 6, 2, 4, 5")), SPECTRAL
    yield "light, d65", light(spectrum("d65", scale=5.0)), SPECTRAL
    yield "light, uniform", light(spectrum("uniform", value=5.0)), SPECTRAL
    listed = named("radiance", "400:2, 500:4, 600:8, 700:5")
    yield "light, listed", light(listed), SPECTRAL
    yield "light, listed, in RGB", light(listed)
    yield "surfaces, sampled", surfaces(
        matte(spectrum("regular", values="0.1, 0.2, 0.3, 0.5, 0.8, 0.7, 0.4", **RANGE)),
        matte(spectrum("irregular", wavelengths=NODES, values="0.7, 0.6, 0.2, 0.4, 0.5"))), SPECTRAL
    yield "surfaces, uniform", surfaces(matte(spectrum("uniform", value=0.6)), matte(named("reflectance", 0.3))), SPECTRAL
    first, second = (matte(named("reflectance", text)) for text in ("400:0.1, 500:0.2, 600:0.3, 700:0.9", "400:0.8, 550:0.5, 700:0.1"))
    yield "surfaces, listed", surfaces(first, second), SPECTRAL
    yield "surfaces, listed, in RGB", stage(constant(0.8), two_balls(first, second))
    yield "metal by spectra", surfaces(
        bsdf("conductor", eta=spectrum("regular", values="0.2, 0.4, 0.9, 1.2, 1.4, 1.5, 1.6", **RANGE), k=spectrum("uniform", value=3.0)),
        bsdf("roughconductor", distribution="ggx", alpha=0.2, eta=spectrum("uniform", value=0.3), k=spectrum("uniform", value=2.5))), SPECTRAL
