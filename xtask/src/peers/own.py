"""Scenes in Dürer's language, and Mitsuba's dictionaries of the same scenes."""

import mitsuba as mi
import numpy as np

SIZE = 32


def T(matrix):
    return mi.ScalarTransform4f(matrix)


def words(values):
    return " ".join(f"{v:g}" for v in values)


def rgb(color):
    return {"type": "rgb", "value": list(color)}


class Scene:
    """A scene for both programs: Mitsuba's dictionary, and the text of Dürer's scene file.

    The names of the first fields are those of `scene.Scene`.
    """
    kind, extension, samples = "Dürer's language", "txt", 128
    warns, differs, mitsuba_is_wrong = (), "", ""

    def __init__(self, name, bounces=6, volumes=False, eye=(0, 0, 3.9), direction=(0, 0, -1), fov=39):
        self.name, self.bounces = name, bounces
        kind = "volpath" if volumes else "path"
        target = [o + d for o, d in zip(eye, direction)]
        self.theirs = {
            "type": "scene",
            "integrator": {"type": kind, "max_depth": bounces + 2, "rr_depth": 1000},
            "sensor": {
                "type": "perspective", "fov": fov, "fov_axis": "y",
                "to_world": mi.ScalarTransform4f().look_at(origin=list(eye), target=target, up=[0, 1, 0]),
                "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
                "sampler": {"type": "independent"},
            },
        }
        self.camera = f"PerspectiveCamera {{ center {words(eye)} direction {words(direction)} up 0 1 0 angle {fov} }}"
        self.background, self.fog, self.lights, self.materials, self.objects = (0, 0, 0), "", [], [], []

    @property
    def slug(self):
        return f"own-{self.name}".replace(" ", "-")

    @property
    def options(self):
        return ["--size", f"{SIZE}x{SIZE}", "--integrator", "path", "--bounces", str(self.bounces)]

    def load(self, mitsuba, path):
        mitsuba.set_variant("scalar_rgb")
        return mitsuba.load_dict(self.theirs)

    @property
    def text(self):
        lights = f"Lights {{ {' '.join(self.lights)} }}\n" if self.lights else ""
        return (f"{self.camera}\nBackground {{ color {words(self.background)} }}\n{self.fog}\n{lights}"
                f"Materials {{ {' '.join(self.materials)} }}\nGroup {{ {' '.join(self.objects)} }}\n")

    def put(self, material, shape, theirs):
        if material not in self.materials:
            self.materials.append(material)
        self.objects.append(f"MaterialIndex {self.materials.index(material)} {shape}")
        self.theirs[f"o{len(self.objects)}"] = theirs

    def rectangle(self, corner, e0, e1, surface, emitted=None):
        material, bsdf = surface if emitted is None else (lamp(emitted), matte((0, 0, 0))[1])
        c, a, b = (np.array(v, float) for v in (corner, e0, e1))
        n = np.cross(a, b) / np.linalg.norm(np.cross(a, b))
        m = np.eye(4)
        m[:3, 0], m[:3, 1], m[:3, 2], m[:3, 3] = a / 2, b / 2, n, c + a / 2 + b / 2
        theirs = {"type": "rectangle", "to_world": T(m.tolist()), "bsdf": bsdf}
        if emitted is not None:
            theirs["emitter"] = {"type": "area", "radiance": rgb(emitted)}
        shape = f"Rectangle {{ corner {words(corner)} edge0 {words(e0)} edge1 {words(e1)} }}"
        self.put(material, shape, theirs)

    def sphere(self, center, radius, surface, emitted=None, medium=None):
        material, bsdf = surface if emitted is None else (lamp(emitted), matte((0, 0, 0))[1])
        theirs = {"type": "sphere", "center": list(center), "radius": radius, "bsdf": bsdf}
        if emitted is not None:
            theirs["emitter"] = {"type": "area", "radiance": rgb(emitted)}
        if medium is not None:
            theirs["interior"] = medium
        self.put(material, f"Sphere {{ center {words(center)} radius {radius:g} }}", theirs)

    def box(self, power=(12, 10, 8)):
        """Adds five walls and an area light below the ceiling."""
        white, red, green = matte((0.7, 0.7, 0.7)), matte((0.6, 0.1, 0.1)), matte((0.1, 0.5, 0.1))
        for corner, e0, e1, wall in [
            ((-1, -1, -1), (0, 0, 2), (2, 0, 0), white), ((-1, 1, -1), (2, 0, 0), (0, 0, 2), white),
            ((-1, -1, -1), (2, 0, 0), (0, 2, 0), white), ((-1, -1, -1), (0, 2, 0), (0, 0, 2), red),
            ((1, -1, -1), (0, 0, 2), (0, 2, 0), green),
        ]:
            self.rectangle(corner, e0, e1, (wall[0], {"type": "twosided", "b": wall[1]}))
        if power is not None:
            self.rectangle((-0.35, 0.99, -0.35), (0.7, 0, 0), (0, 0, 0.7), None, power)
        return self


def matte(c):
    return (f"PrincipledMaterial {{ baseColor {words(c)} specularWeight 0 }}", {"type": "diffuse", "reflectance": rgb(c)})


def lamp(e):
    return f"PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 1 emissionColor {words(e)} }}"


def glass(ior=1.5, rest=""):
    return (f"PrincipledMaterial {{ transmissionWeight 1 specularRoughness 0 specularIor {ior:g} {rest} }}",
            {"type": "dielectric", "int_ior": ior, "ext_ior": 1.0} if ior != 1 else {"type": "null"})


def medium(extinction, albedo, g=0.0):
    """Returns a medium for Dürer and for Mitsuba. Extinction is per unit, equal for all colours."""
    left = float(np.exp(-extinction))
    scatter = [extinction * a for a in albedo]
    ours = (f"transmissionDepth 1 transmissionColor {left:.8g} {left:.8g} {left:.8g} transmissionScatter {words(scatter)} "
            f"transmissionScatterAnisotropy {g:g}")
    theirs = {"type": "homogeneous", "sigma_t": extinction, "albedo": rgb(albedo), "phase": {"type": "hg", "g": g}}
    return ours, theirs


LEFT, RIGHT = ((-0.4, -0.55, 0.2), 0.45), ((0.45, -0.6, -0.3), 0.4)
MIRROR = ("PrincipledMaterial { baseColor 1 1 1 baseMetalness 1 specularRoughness 0 }", {"type": "conductor", "material": "none"})


def scenes():
    def balls(name, a, b, bounces=12, **more):
        s = Scene(name, bounces, **more).box()
        s.sphere(*LEFT, a)
        s.sphere(*RIGHT, b)
        return s

    yield balls("matte balls", matte((0.5, 0.5, 0.5)), matte((0.8, 0.6, 0.2)))
    yield balls("direct light only", matte((0.5, 0.5, 0.5)), matte((0.8, 0.6, 0.2)), 0)
    yield balls("one bounce", matte((0.5, 0.5, 0.5)), matte((0.8, 0.6, 0.2)), 1)
    yield balls("glass and mirror", glass(), MIRROR)
    yield balls("diamond and water", glass(2.4), glass(1.33))
    rough = lambda r: (
        (f"PrincipledMaterial {{ transmissionWeight 1 specularRoughness {r:g} }}",
         {"type": "roughdielectric", "distribution": "ggx", "alpha": r * r, "int_ior": 1.5, "ext_ior": 1.0}),
        (f"PrincipledMaterial {{ baseColor 1 1 1 baseMetalness 1 specularRoughness {r:g} }}",
         {"type": "roughconductor", "distribution": "ggx", "alpha": r * r, "material": "none"}))
    yield balls("slightly rough glass and metal", *rough(0.2))
    s = Scene("plastic and a pane", 12).box()
    s.sphere(*LEFT, ("PrincipledMaterial { baseColor 0.2 0.5 0.8 specularRoughness 0 }",
                     {"type": "plastic", "diffuse_reflectance": rgb((0.2, 0.5, 0.8)), "nonlinear": False, "int_ior": 1.5, "ext_ior": 1.0}))
    s.rectangle((0, -1, 0.3), (0.8, 0, 0.1), (0, 1.2, 0), (
        "PrincipledMaterial { transmissionWeight 1 specularRoughness 0 walls thin }", {"type": "thindielectric", "int_ior": 1.5, "ext_ior": 1.0}))
    yield s

    def outside(name, **more):
        s = Scene(name, 12, eye=(0, 0.6, 4), direction=(0, -0.12, -1), fov=40, **more)
        s.rectangle((-50, -0.6, 50), (100, 0, 0), (0, 0, -100), matte((0.5, 0.4, 0.3)))
        s.sphere((-0.7, 0, 0), 0.6, matte((0.7, 0.7, 0.7)))
        return s

    def sky(s):
        s.background = (0.4, 0.5, 0.7)
        s.theirs["env"] = {"type": "constant", "radiance": rgb(s.background)}
        return s

    s = sky(outside("open sky and a light"))
    s.sphere((0.7, 0, 0), 0.6, glass())
    s.sphere((0, 3, 1), 0.8, None, (5, 4, 4))
    yield s
    s = outside("a point light")
    # Dürer's colour is the radiance of a white surface, which is irradiance over pi.
    s.lights.append("PointLight { position 1 3 2 color 6 5 4 attenuation 0 0 1 }")
    s.theirs["l"] = {"type": "point", "position": [1, 3, 2], "intensity": rgb([np.pi * c for c in (6, 5, 4)])}
    yield s
    s = sky(outside("a directional light"))
    s.lights.append("DirectionalLight { direction -1 -2 -1 color 1 0.9 0.7 }")
    s.theirs["l"] = {"type": "directional", "direction": [-1, -2, -1], "irradiance": rgb([np.pi * c for c in (1, 0.9, 0.7)])}
    yield s
    s = outside("fifty lights")
    turns = np.linspace(0, 2 * np.pi, 50, endpoint=False)
    for i, turn in enumerate(turns):
        center = (2 * np.cos(turn), 0.5 + 0.02 * i, 2 * np.sin(turn) - 0.5)
        s.sphere(center, 0.05, None, (10 + i, 40 - i / 2, 20))
    yield s

    inside, theirs = medium(2.0, (0.0, 0.0, 0.0))
    s = Scene("glass that absorbs", 12, volumes=True).box()
    s.sphere(*LEFT, glass(1.5, inside), medium=theirs)
    s.sphere(*RIGHT, matte((0.5, 0.5, 0.5)))
    yield s
    for name, ior, extinction, albedo, g in [
        ("a cloud", 1.0, 3.0, (0.9, 0.8, 0.6), 0.0), ("a forward-scattering cloud", 1.0, 5.0, (0.95, 0.95, 0.9), 0.7),
    ]:
        inside, theirs = medium(extinction, albedo, g)
        s = sky(outside(name, volumes=True))
        s.bounces, s.theirs["integrator"]["max_depth"] = 60, 62
        s.sphere((0.7, 0, 0), 0.6, glass(ior, inside), medium=theirs)
        s.sphere((0, 3, 1), 0.8, None, (5, 4, 4))
        yield s
    inside, theirs = medium(4.0, (0.9, 0.85, 0.7))
    s = sky(outside("milky glass", volumes=True))
    # Dürer does not count transmission as a bounce, so both limits are too high to have an effect.
    s.bounces, s.theirs["integrator"]["max_depth"] = 100, 400
    s.sphere((0.7, 0, 0), 0.6, glass(1.5, inside), medium=theirs)
    yield s
    s = sky(Scene("fog in a box", 40, volumes=True, eye=(0, 0.3, 5)))
    s.fog = "Fog { extinction 0.7 color 0.9 0.8 0.7 anisotropy 0.4 min -1 -1 -1 max 1 1 1 }"
    _, theirs = medium(0.7, (0.9, 0.8, 0.7), 0.4)
    s.theirs["fog"] = {"type": "cube", "bsdf": {"type": "null"}, "interior": theirs}
    s.sphere((0, 0, 0), 0.5, matte((0.5, 0.5, 0.5)))
    s.sphere((2, 3, 1), 0.8, None, (5, 4, 4))
    yield s
