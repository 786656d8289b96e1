"""Colours that are given as spectra."""

import mitsuba_xml as x
from mitsuba_xml import bsdf, constant, emitter, floor, lamp, shape, spectrum, two_balls
from scene import stage

REGULAR = dict(wavelength_min=400.0, wavelength_max=700.0, values="0.1, 0.2, 0.3, 0.5, 0.8, 0.7, 0.4")
IRREGULAR = dict(wavelengths="360, 450, 520, 600, 830", values="0.7, 0.6, 0.2, 0.4, 0.5")


def named(name, value):
    return f'<spectrum name="{name}" value="{value}"/>'


def matte(reflectance):
    return bsdf("diffuse", reflectance) if reflectance.startswith("<spectrum name") else bsdf("diffuse", reflectance=reflectance)


def reflecting(first, second):
    return stage(constant(0.5), floor(), lamp(), two_balls(matte(first), matte(second)))


def emitting(light):
    source = emitter("area", light) if light.startswith("<spectrum name") else emitter("area", radiance=light)
    return stage(floor(), x.rectangle(source, size=(0.7, 0.7), turn=[x.DOWN], at=(0.3, 2.6, 0.8)), two_balls(x.diffuse(0.7, 0.4, 0.3), bsdf("plastic")))


def scenes():
    yield "reflectances, sampled", reflecting(spectrum("regular", **REGULAR), spectrum("irregular", **IRREGULAR))
    yield "reflectances, uniform", reflecting(spectrum("uniform", value=0.6), named("reflectance", 0.3))
    yield "reflectances, listed", reflecting(named("reflectance", "400:0.1, 500:0.2, 600:0.3, 700:0.9"), named("reflectance", "400:0.8, 550:0.5, 700:0.1"))
    yield "black body, 2800 K", emitting(spectrum("blackbody", temperature=2800.0))
    yield "black body, 6500 K", emitting(spectrum("blackbody", temperature=6500.0))
    yield "light, regular", emitting(spectrum("regular", **(REGULAR | {"values": "1, 2, 3, 5, 8, 7, 4"})))
    yield "light, d65", emitting(spectrum("d65", scale=5.0))
    yield "light, uniform", emitting(spectrum("uniform", value=5.0))
    yield "light, listed", emitting(named("radiance", "400:2, 500:4, 600:8, 700:5"))
    yield "metal by spectra", stage(constant(0.5), floor(), lamp(), two_balls(
        bsdf("conductor", eta=spectrum("regular", **(REGULAR | {"values": "0.2, 0.4, 0.9, 1.2, 1.4, 1.5, 1.6"})), k=spectrum("uniform", value=3.0)),
        bsdf("roughconductor", distribution="ggx", alpha=0.2, eta=spectrum("uniform", value=0.3), k=spectrum("uniform", value=2.5))))
