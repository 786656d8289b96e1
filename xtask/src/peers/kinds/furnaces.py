"""White surfaces in uniform light, which shows lost and created light."""

import mitsuba_xml as x
from mitsuba_xml import ball, bsdf, constant
from scene import stage


def furnace(material):
    return stage(constant(0.5), ball(material, y=0.45, radius=1.1))


# Dürer says so where the whole picture has one colour, as it should.
EVEN = dict(warns=("the picture has only one colour", "the whole picture is uniformly"))


def scenes():
    yield "matte", furnace(bsdf("twosided", x.diffuse(1.0))), EVEN
    yield "mirror", furnace(bsdf("conductor", material="none")), EVEN
    for alpha in (0.1, 0.4, 0.8):
        yield f"metal, alpha {alpha}", furnace(bsdf("roughconductor", distribution="ggx", material="none", alpha=alpha))
    for u, v in ((0.05, 0.3), (0.6, 0.1), (0.3, 0.9)):
        yield f"metal, alpha {u} x {v}", furnace(bsdf("roughconductor", distribution="ggx", material="none", alpha_u=u, alpha_v=v))
    yield "clear glass", furnace(bsdf("dielectric", int_ior=1.5))
    yield "diamond", furnace(bsdf("dielectric", int_ior="diamond"))
    for alpha, index in ((0.1, 1.33), (0.3, 1.5), (0.6, 2.0)):
        yield f"glass, alpha {alpha}, index {index}", furnace(bsdf("roughdielectric", distribution="ggx", alpha=alpha, int_ior=index))
    yield "white plastic", furnace(bsdf("plastic", diffuse_reflectance=(1.0, 1.0, 1.0)))
    yield "white nonlinear plastic", furnace(bsdf("plastic", diffuse_reflectance=(1.0, 1.0, 1.0), nonlinear=True))
    yield "rough white plastic", furnace(bsdf("roughplastic", distribution="ggx", alpha=0.2, diffuse_reflectance=(1.0, 1.0, 1.0)))
    yield "white principled", furnace(bsdf("principled", base_color=(1.0, 1.0, 1.0), roughness=0.4))
