"""Disney's material, `principled` and `principledthin`."""

from mitsuba_xml import bitmap, bsdf, constant, floor, lamp, rectangle, two_balls
from scene import stage


def room(first, second=None):
    return stage(constant(0.3, 0.35, 0.4), floor(), lamp(), two_balls(first, second or first))


def disney(**more):
    return bsdf("principled", **({"base_color": (0.7, 0.35, 0.2)} | more))


def panes(**more):
    thin = bsdf("principledthin", **({"base_color": (0.3, 0.6, 0.8)} | more))
    pane = lambda at: rectangle(thin, size=(0.6, 0.7), turn=[("rotate", (0, 1, 0), 25)], at=at)
    return stage(constant(0.3, 0.35, 0.4), floor(), lamp(), pane((-0.7, 0.75, 0)), pane((0.7, 0.75, -0.4)))


def scenes():
    yield "default", room(disney(), disney(base_color=(0.2, 0.4, 0.8)))
    yield "roughness 0.2 and 0.9", room(disney(roughness=0.2), disney(roughness=0.9))
    yield "metallic", room(disney(metallic=1.0, roughness=0.3), disney(metallic=0.5, roughness=0.5))
    yield "anisotropic metal", room(disney(metallic=1.0, roughness=0.4, anisotropic=0.8), disney(metallic=1.0, roughness=0.6, anisotropic=0.4))
    yield "specular and eta", room(disney(specular=0.1, roughness=0.3), disney(eta=1.8, roughness=0.3))
    yield "spec_tint", room(disney(spec_tint=1.0, roughness=0.3), disney(spec_tint=0.5, roughness=0.4))
    yield "clearcoat", room(disney(clearcoat=1.0, clearcoat_gloss=0.0), disney(clearcoat=1.0, clearcoat_gloss=0.9))
    yield "sheen", room(disney(sheen=1.0, roughness=0.8), disney(sheen=1.0, sheen_tint=1.0, roughness=0.8))
    yield "spec_trans", room(disney(spec_trans=1.0, roughness=0.2, base_color=(0.9, 0.9, 0.9)), disney(spec_trans=0.5, roughness=0.3))
    yield "flatness", room(disney(flatness=1.0, roughness=0.6), disney(flatness=0.5, roughness=0.4))
    yield "textures", room(disney(base_color=bitmap("colors.png")), disney(roughness=bitmap("grey.png", raw=True), metallic=1.0))
    yield "thin, diffuse", panes(diff_trans=0.0)
    yield "thin, translucent", panes(diff_trans=1.0)
    yield "thin, through", panes(diff_trans=1.6, roughness=0.7)
    yield "thin, spec_trans", panes(spec_trans=0.8, roughness=0.3)
    yield "thin, sheen", panes(sheen=1.0, diff_trans=0.6)
    yield "thin, flatness", panes(flatness=1.0)
