"""Materials: shader nodes of Blender as principled materials of Dürer and mixtures of them."""

from dataclasses import dataclass, field
from typing import Optional, Union

import numpy as np

from .nodes import Evaluator, Field, Mapping, Untranslated, VertexColors, combine, constant, find, follow, gray, read_image
from .units import block, metal_edge, stretched

#: Number fields that can have a texture. A texture of another field becomes its mean.
TEXTURED_NUMBERS = {
    "baseDiffuseRoughness", "baseMetalness", "specularWeight", "specularRoughness", "specularAnisotropy", "specularRotation",
    "transmissionWeight", "subsurfaceWeight", "coatWeight", "coatRoughness", "fuzzWeight", "fuzzRoughness",
    "thinFilmThickness",
}  # fmt: skip
#: Colour fields that can have a texture.
TEXTURED_COLORS = {"baseColor", "specularColor", "transmissionColor", "subsurfaceColor", "coatColor", "fuzzColor"}


#: Opacity of lights with an extent. In Blender, they hide nothing and cast no shadows. Their radiance
#: is divided by the opacity, so that they give the same light. A lower value would be noisier.
LIGHT_OPACITY = 0.1


@dataclass
class Layered:
    """A principled material."""

    fields: dict = field(default_factory=dict)
    #: File and mapping of each texture, by the name of its field.
    textures: dict = field(default_factory=dict)
    opacity: Field = field(default_factory=lambda: constant(1))
    colors: Optional[VertexColors] = None

    @property
    def emits(self):
        return self.fields.get("emissionLuminance", 0) > 0


@dataclass
class Clear:
    """A surface that lets all light pass straight through, times a colour."""

    color: np.ndarray


@dataclass
class Blend:
    """A mixture of two surfaces. `share` is that of the first."""

    first: "Surface"
    second: "Surface"
    share: float
    texture: Optional[tuple] = None


Surface = Union[Layered, Clear, Blend]


def layers(surface):
    """Returns the principled materials in a surface."""
    if isinstance(surface, Blend):
        return layers(surface.first) + layers(surface.second)
    return [surface] if isinstance(surface, Layered) else []


class Translator:
    """Translates one material."""

    def __init__(self, name, textures, report):
        self.name, self.textures, self.report = name, textures, report
        self.evaluator = Evaluator(lambda image, user: read_image(image, report))

    def lost(self, text):
        self.report.add(f"material {self.name}: {text}")

    def surface(self, material):
        """Returns the surface of a material of Blender."""
        tree = material.node_tree if getattr(material, "use_nodes", True) else None
        if tree is None:
            made = Layered({"specularWeight": 0})
            made.fields["baseColor"] = tuple(material.diffuse_color[:3])
            return made
        end = tree.get_output_node("CYCLES") or tree.get_output_node("ALL")
        if end is None or not end.inputs["Surface"].is_linked:
            if end is not None and end.inputs["Volume"].is_linked:
                self.lost("volumes are not translated: its objects are invisible")
                return Clear(np.ones(3))
            self.lost("no shader is connected to its output: it is black")
            return black()
        if end.inputs["Volume"].is_linked:
            self.lost("volumes are not translated")
        try:
            made = self.shader(end.inputs["Surface"], ())
        except Untranslated as reason:
            self.lost(f"{reason}: it is grey")
            made = plain()
        self.displacement(end.inputs["Displacement"], made, material)
        return made

    def displacement(self, socket, made, material):
        """Translates a displacement as a bump map."""
        try:
            output, _, stack = follow(socket, ())
            if output is None:
                return
            node = output.node
            if node.bl_idname != "ShaderNodeDisplacement":
                raise Untranslated(f"the displacement by {node.bl_label} is not translated")
            if getattr(material, "displacement_method", "BUMP") != "BUMP":
                self.lost("its displacement only tilts the normals, as with the method Bump Only")
            for part in layers(made):
                self.bump(part, find(node, "Height"), self.fixed(node, stack, "Scale"), stack)
        except Untranslated as reason:
            self.lost(str(reason))

    def shader(self, socket, stack):
        """Returns the surface of a shader input."""
        output, _, inner = follow(socket, stack)
        if output is None:
            return black()
        node = output.node
        rule = getattr(self, f"_{node.bl_idname}", None)
        if rule is None:
            raise Untranslated(f"the shader {node.bl_label} is not translated")
        return rule(node, inner)

    # Values of inputs.

    def field(self, node, stack, *names, default=None):
        """Returns the field of an input, which cannot be vertex colours."""
        found = self.color(node, stack, *names, default=default)
        if isinstance(found, VertexColors):
            self.lost(f"{names[0]} of {node.bl_label}: vertex colours are not translated here")
            return constant(0 if default is None else default)
        return found

    def color(self, node, stack, *names, default=None):
        """Returns the field of an input. An input that has no counterpart is reported, and has the
        value that it would have without a link."""
        socket = find(node, *names)
        if socket is None:
            return constant(0 if default is None else default)
        try:
            return self.evaluator.value(socket, stack)
        except Untranslated as reason:
            self.lost(f"{socket.name} of {node.bl_label}: {reason}, so its own value is used")
            return constant(socket.default_value if hasattr(socket, "default_value") else 0)

    def fixed(self, node, stack, *names, default=0.0):
        """Returns an input as one number. A texture becomes its mean."""
        found = self.field(node, stack, *names, default=default)
        if not found.is_constant:
            self.lost(f"{names[0]} of {node.bl_label} can have no texture: its mean is used")
        return float(found.values[..., 0].mean())

    def set_number(self, made, name, found, low=0.0, high=1.0):
        """Sets a number field to a constant or a texture."""
        if found.is_constant or name not in TEXTURED_NUMBERS:
            if not found.is_constant:
                self.lost(f"{name} can have no texture: its mean is used")
            made.fields[name] = float(np.clip(found.values[..., 0].mean(), low, high))
            return
        values = np.clip(found.values[..., :1], low, high)
        made.fields[name] = 1.0
        made.textures[f"{name}Texture"] = (self.textures.file(np.repeat(values, 3, -1), True), found.mapping, ())

    def set_color(self, made, name, found):
        """Sets a colour field to a constant, a texture or vertex colours."""
        if isinstance(found, VertexColors):
            if name != "baseColor":
                self.lost(f"vertex colours are not translated for {name}")
                return
            made.colors, made.fields[name] = found, (1.0, 1.0, 1.0)
        elif found.is_constant or name not in TEXTURED_COLORS:
            if not found.is_constant:
                self.lost(f"{name} can have no texture: its mean is used")
            made.fields[name] = tuple(np.maximum(found.values[..., :3].reshape(-1, 3).mean(0), 0))
        else:
            made.fields[name] = (1.0, 1.0, 1.0)
            made.textures[f"{name}Texture"] = (self.color_file(found), found.mapping, ())

    def color_file(self, found):
        if found.srgb is not None:
            return self.textures.srgb_file(found.srgb)
        return self.textures.file(np.maximum(found.values[..., :3], 0), False)

    def set_emission(self, made, color, strength):
        """Sets the emission to the product of two fields."""
        if isinstance(color, VertexColors):
            if not strength.is_constant:
                self.lost("emission by vertex colours times a texture is not translated")
                return
            made.colors, made.fields["emissionVertexColors"] = color, "on"
            made.fields["emissionLuminance"] = max(float(strength.values[0]), 0)
            return
        light = combine(lambda c, s: np.maximum(c * s[..., :1], 0), color, strength)
        if light.is_constant:
            most = float(light.values[:3].max())
            if most > 0:
                made.fields["emissionLuminance"] = most
                made.fields["emissionColor"] = tuple(light.values[:3] / most)
        elif strength.is_constant:
            made.fields["emissionLuminance"] = max(float(strength.values[0]), 0)
            made.textures["emissionTexture"] = (self.color_file(color), color.mapping, ())
        else:
            made.fields["emissionLuminance"] = 1.0
            made.textures["emissionTexture"] = (self.color_file(light), light.mapping, ())

    # Normals.

    def set_normal(self, made, node, stack, *names):
        """Translates a normal map or a bump map."""
        socket = find(node, *(names or ("Normal",)))
        if socket is None:
            return
        try:
            output, _, inner = follow(socket, stack)
            if output is not None:
                self._normal(made, output.node, inner)
        except Untranslated as reason:
            self.lost(f"{socket.name} of {node.bl_label}: {reason}, so it is ignored")

    def _normal(self, made, node, stack):
        if node.bl_idname == "ShaderNodeBump":
            sign = -1 if node.invert else 1
            height = self.fixed(node, stack, "Distance", default=1.0) * self.fixed(node, stack, "Strength", default=1.0)
            self.bump(made, find(node, "Height"), sign * height, stack)
            self.set_normal(made, node, stack)
            return
        if node.bl_idname != "ShaderNodeNormalMap":
            raise Untranslated(f"the node {node.bl_label} is not translated")
        if node.space != "TANGENT":
            raise Untranslated("normal maps in object or world space are not translated")
        color, strength = self.evaluator.value(node.inputs["Color"], stack), self.fixed(node, stack, "Strength", default=1.0)
        if isinstance(color, VertexColors) or color.is_constant:
            raise Untranslated("a normal map is not a picture")
        values = color.values[..., :3]
        if strength != 1:
            slope = (values * 2 - 1) * np.array([strength, strength, 1], np.float32)
            slope[..., 2] = 1 + (slope[..., 2] - 1) * min(max(strength, 0), 1)
            slope[..., 2] = np.maximum(slope[..., 2], 1e-4)
            values = slope / np.linalg.norm(slope, axis=-1, keepdims=True) * 0.5 + 0.5
        mapping = color.mapping
        if node.uv_map and not mapping.uv_map:
            mapping = Mapping(mapping.matrix, node.uv_map, mapping.wrap, mapping.texels)
        made.textures["normalTexture"] = (self.textures.file(values, True), mapping, ())

    def bump(self, made, socket, height, stack):
        found = self.evaluator.value(socket, stack)
        if isinstance(found, VertexColors):
            raise Untranslated("a bump map by vertex colours is not translated")
        if found.is_constant:
            return
        made.textures["bumpTexture"] = (self.textures.file(gray(found.values[..., 0])[..., :3], True), found.mapping, ())
        made.fields["bumpHeight"] = height

    # Shaders.

    def _ShaderNodeBsdfPrincipled(self, node, stack):
        made, color = Layered(), self.color(node, stack, "Base Color")
        self.set_color(made, "baseColor", color)
        metallic = self.field(node, stack, "Metallic")
        self.set_number(made, "baseMetalness", metallic)
        anisotropic, roughness = self.field(node, stack, "Anisotropic"), self.field(node, stack, "Roughness")
        if not anisotropic.is_constant or anisotropic.values[0] > 0:
            # Blender stretches highlights by 0.9 of the parameter.
            self.set_number(made, "specularAnisotropy", anisotropic.then(lambda v: 0.9 * v))
            self.set_number(made, "specularRotation", self.field(node, stack, "Anisotropic Rotation"))
            ratio = 1 - 0.9 * float(np.clip(anisotropic.values[..., 0].mean(), 0, 1))
            roughness = roughness.then(lambda v: v * stretched(ratio))
        self.set_number(made, "specularRoughness", roughness)
        made.fields["specularIor"] = max(self.fixed(node, stack, "IOR", default=1.5), 1e-3)
        self.set_number(made, "baseDiffuseRoughness", self.field(node, stack, "Diffuse Roughness"))
        if made.fields["baseMetalness"] < 1 or "baseMetalnessTexture" in made.textures:
            level = self.field(node, stack, "Specular IOR Level", "Specular", default=0.5)
            self.set_number(made, "specularWeight", level.then(lambda v: 2 * v), 0, 10)
        tint = find(node, "Specular Tint")
        if tint is not None and tint.type == "RGBA":
            self.set_color(made, "specularColor", self.field(node, stack, "Specular Tint"))
        if node.distribution == "GGX":
            made.fields["energyCompensation"] = "off"
        self._transmission(made, node, stack, color)
        self._subsurface(made, node, stack, color)
        self._coat(made, node, stack)
        sheen = self.field(node, stack, "Sheen Weight", "Sheen")
        if not sheen.is_constant or sheen.values[0] > 0:
            self.set_number(made, "fuzzWeight", sheen)
            self.set_number(made, "fuzzRoughness", self.field(node, stack, "Sheen Roughness", default=0.5))
            if find(node, "Sheen Tint") is not None and find(node, "Sheen Tint").type == "RGBA":
                self.set_color(made, "fuzzColor", self.field(node, stack, "Sheen Tint"))
        film = self.field(node, stack, "Thin Film Thickness")
        if not film.is_constant or film.values[0] > 0:
            made.fields["thinFilmWeight"] = 1.0
            self.set_number(made, "thinFilmThickness", film.then(lambda v: v / 1000), 0, 100)
            made.fields["thinFilmIor"] = max(self.fixed(node, stack, "Thin Film IOR", default=1.33), 1e-3)
        strength = self.field(node, stack, "Emission Strength", default=1.0)
        self.set_emission(made, self.color(node, stack, "Emission Color", "Emission"), strength)
        made.opacity = self.field(node, stack, "Alpha", default=1.0)
        self.set_normal(made, node, stack)
        return made

    def _transmission(self, made, node, stack, color):
        weight = self.field(node, stack, "Transmission Weight", "Transmission")
        if weight.is_constant and weight.values[0] <= 0:
            return
        self.set_number(made, "transmissionWeight", weight)
        if isinstance(color, VertexColors):
            self.lost("vertex colours do not tint transmitted light")
            return
        # Light that enters and leaves passes two surfaces.
        self.set_color(made, "transmissionColor", color.then(lambda v: np.sqrt(np.maximum(v, 0))))
        made.fields["surroundings"] = "ignored"

    def _subsurface(self, made, node, stack, color):
        weight = self.field(node, stack, "Subsurface Weight", "Subsurface")
        if weight.is_constant and weight.values[0] <= 0:
            return
        self.set_number(made, "subsurfaceWeight", weight)
        self.set_color(made, "subsurfaceColor", color)
        self._radius(made, node, stack, "Subsurface Radius", "Subsurface Scale")
        anisotropy = self.fixed(node, stack, "Subsurface Anisotropy")
        made.fields["subsurfaceScatterAnisotropy"] = min(max(anisotropy, -0.99), 0.99)

    def _radius(self, made, node, stack, radius, scale):
        radii = self.field(node, stack, radius, default=(1.0, 0.2, 0.1))
        radii = np.maximum(radii.values[..., :3].reshape(-1, 3).mean(0), 1e-6) * max(self.fixed(node, stack, scale, default=1.0), 0)
        most = max(float(radii.max()), 1e-6)
        made.fields["subsurfaceRadius"], made.fields["subsurfaceRadiusScale"] = most, tuple(radii / most)

    def _coat(self, made, node, stack):
        weight = self.field(node, stack, "Coat Weight", "Clearcoat")
        if weight.is_constant and weight.values[0] <= 0:
            return
        self.set_number(made, "coatWeight", weight)
        self.set_number(made, "coatRoughness", self.field(node, stack, "Coat Roughness", "Clearcoat Roughness"))
        made.fields["coatIor"] = max(self.fixed(node, stack, "Coat IOR", default=1.5), 1e-3)
        # In Cycles, light is not reflected back inside the coat.
        made.fields["coatDarkening"] = 0.0
        if find(node, "Coat Tint") is not None:
            self.set_color(made, "coatColor", self.field(node, stack, "Coat Tint"))
        normal = find(node, "Coat Normal", "Clearcoat Normal")
        if normal is not None and normal.is_linked:
            self.lost("the coat has the normals of the base: Coat Normal is ignored")

    def _ShaderNodeBsdfDiffuse(self, node, stack):
        made = Layered({"specularWeight": 0})
        self.set_color(made, "baseColor", self.color(node, stack, "Color"))
        self.set_number(made, "baseDiffuseRoughness", self.field(node, stack, "Roughness"))
        self.set_normal(made, node, stack)
        return made

    def _glossy(self, node, stack, color):
        made = Layered({"baseMetalness": 1})
        self.set_color(made, "baseColor", color)
        if not isinstance(color, VertexColors):
            self.set_color(made, "specularColor", color.then(_edge))
        if node.distribution != "MULTI_GGX":
            made.fields["energyCompensation"] = "off"
        roughness, anisotropy = self.field(node, stack, "Roughness"), self.fixed(node, stack, "Anisotropy")
        if anisotropy != 0:
            ratio = max(1 - min(abs(anisotropy), 0.99), 0.01) ** 2
            roughness = roughness.then(lambda v: v * stretched(ratio))
            made.fields["specularAnisotropy"] = 1 - ratio
            # A positive value stretches highlights across the tangent.
            made.fields["specularRotation"] = self.fixed(node, stack, "Rotation") + (0.25 if anisotropy > 0 else 0.0)
        self.set_number(made, "specularRoughness", roughness)
        self.set_normal(made, node, stack)
        return made

    def _ShaderNodeBsdfAnisotropic(self, node, stack):
        return self._glossy(node, stack, self.color(node, stack, "Color"))

    _ShaderNodeBsdfGlossy = _ShaderNodeBsdfAnisotropic

    def _ShaderNodeBsdfMetallic(self, node, stack):
        if node.fresnel_type == "F82":
            made = self._glossy(node, stack, self.field(node, stack, "Base Color"))
            made.textures.pop("specularColorTexture", None)
            self.set_color(made, "specularColor", self.field(node, stack, "Edge Tint"))
            return made
        made = self._glossy(node, stack, constant(1))
        made.fields.pop("specularColor", None)
        self.set_color(made, "metalIor", self.field(node, stack, "IOR"))
        self.set_color(made, "metalExtinction", self.field(node, stack, "Extinction"))
        return made

    def _ShaderNodeBsdfGlass(self, node, stack):
        made, color = Layered({"transmissionWeight": 1, "surroundings": "ignored"}), self.field(node, stack, "Color")
        self.set_color(made, "transmissionColor", color)
        self.set_color(made, "specularColor", color)
        self.set_number(made, "specularRoughness", self.field(node, stack, "Roughness"))
        made.fields["specularIor"] = max(self.fixed(node, stack, "IOR", default=1.5), 1e-3)
        if node.distribution != "MULTI_GGX":
            made.fields["energyCompensation"] = "off"
        self.set_normal(made, node, stack)
        return made

    def _ShaderNodeBsdfRefraction(self, node, stack):
        self.lost("a Refraction shader becomes glass without its reflection, which transmits less light")
        made = self._ShaderNodeBsdfGlass(node, stack)
        made.fields["specularColor"] = (0.0, 0.0, 0.0)
        made.textures.pop("specularColorTexture", None)
        return made

    def _ShaderNodeBsdfTransparent(self, node, stack):
        color = self.field(node, stack, "Color")
        if not color.is_constant:
            self.lost("a Transparent shader can have no texture: it is colourless")
            return Clear(np.ones(3))
        return Clear(np.clip(color.values[:3], 0, 1))

    def _ShaderNodeBsdfTranslucent(self, node, stack):
        made = Layered({"specularWeight": 0, "walls": "thin", "subsurfaceWeight": 1, "subsurfaceColor": (0.0, 0.0, 0.0)})
        self.set_color(made, "subsurfaceThrough", self.field(node, stack, "Color"))
        self.set_normal(made, node, stack)
        return made

    def _ShaderNodeSubsurfaceScattering(self, node, stack):
        made = Layered({"specularWeight": 0, "subsurfaceWeight": 1})
        self.set_color(made, "subsurfaceColor", self.field(node, stack, "Color"))
        self._radius(made, node, stack, "Radius", "Scale")
        anisotropy = self.fixed(node, stack, "Anisotropy")
        made.fields["subsurfaceScatterAnisotropy"] = min(max(anisotropy, -0.99), 0.99)
        self.set_normal(made, node, stack)
        return made

    def _ShaderNodeBsdfSheen(self, node, stack):
        made = Layered({"baseColor": (0.0, 0.0, 0.0), "specularWeight": 0, "fuzzWeight": 1})
        self.set_color(made, "fuzzColor", self.field(node, stack, "Color"))
        self.set_number(made, "fuzzRoughness", self.field(node, stack, "Roughness"))
        return made

    def _ShaderNodeEmission(self, node, stack):
        made = black()
        self.set_emission(made, self.color(node, stack, "Color"), self.field(node, stack, "Strength", default=1.0))
        return made

    def _ShaderNodeAddShader(self, node, stack):
        parts = [self.shader(socket, stack) for socket in node.inputs[:2]]
        if all(isinstance(part, Layered) for part in parts):
            lights = [part for part in parts if part.fields.get("baseColor") == (0.0, 0.0, 0.0) and part.emits]
            others = [part for part in parts if not any(part is light for light in lights)]
            if lights and len(others) == 1 and not others[0].emits:
                whole = others[0]
                whole.fields.update({k: v for k, v in lights[0].fields.items() if k.startswith("emission")})
                whole.textures.update({k: v for k, v in lights[0].textures.items() if k.startswith("emission")})
                return whole
        raise Untranslated("the shader Add is translated only for the sum of an Emission and another shader")

    def _ShaderNodeMixShader(self, node, stack):
        factor_socket, *shaders = node.inputs[:3]
        output, _, inner = follow(factor_socket, stack)
        if output is not None and output.node.bl_idname == "ShaderNodeFresnel":
            return self._plastic(output.node, inner, shaders, stack)
        factor = self.field(node, stack, "Fac", "Factor").then(lambda v: np.clip(v, 0, 1))
        if factor.is_constant and factor.values[0] in (0, 1):
            return self.shader(shaders[int(factor.values[0])], stack)
        first, second = (self.shader(socket, stack) for socket in shaders)
        for one, other, share in ((first, second, factor), (second, first, factor.then(lambda v: 1 - v))):
            if isinstance(one, Clear) and (one.color == 1).all() and layers(other):
                for part in layers(other):
                    part.opacity = combine(np.multiply, part.opacity, share)
                return other
        if factor.is_constant:
            return Blend(second, first, float(factor.values[0]))
        file = self.textures.file(np.repeat(factor.values[..., :1], 3, -1), True)
        return Blend(second, first, 1.0, (file, factor.mapping, ()))

    def _plastic(self, fresnel, inner, shaders, stack):
        """Returns the mixture of a diffuse and a glossy shader by a Fresnel node as a plastic."""
        base, gloss = (self.shader(socket, stack) for socket in shaders)
        if not all(isinstance(part, Layered) for part in (base, gloss)) or gloss.fields.get("baseMetalness") != 1:
            raise Untranslated("a mixture by a Fresnel node is translated only for a diffuse and a glossy shader")
        base.fields["specularWeight"] = 1.0
        base.fields["specularColor"] = gloss.fields["baseColor"]
        base.fields["specularIor"] = max(self.fixed(fresnel, inner, "IOR", default=1.5), 1e-3)
        base.fields["specularRoughness"] = gloss.fields.get("specularRoughness", 0)
        for name, texture in (("specularColorTexture", "baseColorTexture"), ("specularRoughnessTexture",) * 2):
            if texture in gloss.textures:
                base.textures[name] = gloss.textures[texture]
        return base


def _edge(values):
    return np.concatenate([metal_edge(values[..., :3]), values[..., 3:]], -1)


def black():
    """Returns a surface that scatters no light."""
    return Layered({"baseColor": (0.0, 0.0, 0.0), "specularWeight": 0})


def plain():
    """Returns the surface of objects without a material: the defaults of Principled BSDF."""
    return Layered({"baseColor": (0.8, 0.8, 0.8), "specularRoughness": 0.5})


class Materials:
    """Materials of a scene, numbered in the order of the file."""

    def __init__(self, textures, report):
        self.textures, self.report = textures, report
        self.texts = []
        self._surfaces, self._numbers = {}, {}

    def surface(self, material):
        """Returns the surface of a material of Blender, or of no material."""
        key = material.name_full if material is not None else None
        if key not in self._surfaces:
            made = plain() if material is None else Translator(material.name, self.textures, self.report).surface(material)
            self._surfaces[key] = made
        return self._surfaces[key]

    def uv_maps(self, material):
        """Returns the names of the UV maps that a material refers to."""
        used = []
        surface = self.surface(material)
        for part in layers(surface):
            used += [mapping.uv_map for _, mapping, _ in part.textures.values()]
            used += [] if part.opacity.is_constant else [part.opacity.mapping.uv_map]
        if isinstance(surface, Blend) and surface.texture:
            used.append(surface.texture[1].uv_map)
        return [name for name in dict.fromkeys(used) if name]

    def colors(self, material):
        """Returns the vertex colours that a material uses, or None."""
        found = [part.colors for part in layers(self.surface(material)) if part.colors is not None]
        return found[0] if found else None

    def number(self, material, active="", second="", unseen=False):
        """Returns the number of a material for a mesh with an active UV map and another one."""
        key = (material.name_full if material is not None else None, active, second, unseen)
        if key not in self._numbers:
            self._numbers[key] = self._write(self.surface(material), active, second, unseen)
        return self._numbers[key]

    def light(self, radiance):
        """Returns the number of the material of a light with a radiance, which the camera does not
        see."""
        most = max(radiance)
        color = tuple(value / most for value in radiance) if most > 0 else (0.0, 0.0, 0.0)
        fields = {**black().fields, "emissionLuminance": most / LIGHT_OPACITY, "emissionColor": color, "opacity": LIGHT_OPACITY}
        return self._add(block("PrincipledMaterial", [*fields.items(), ("seenByCamera", "off")]))

    def _add(self, text):
        self.texts.append(text)
        return len(self.texts) - 1

    def _write(self, surface, active, second, unseen):
        if isinstance(surface, Blend):
            first = self._write(surface.first, active, second, unseen)
            other = self._write(surface.second, active, second, unseen)
            texture = surface.texture and self._texture(surface.texture, active, second)
            fields = [("materialIndex", first), ("materialIndex", other), ("share", surface.share), ("shareTexture", texture)]
            return self._add(block("Mix", fields))
        hidden = [("seenByCamera", "off")] if unseen else []
        if isinstance(surface, Clear):
            if (surface.color == 1).all():
                return self._add(block("PrincipledMaterial", [("opacity", 0), *hidden]))
            fields = [("walls", "thin"), ("transmissionWeight", 1), ("transmissionColor", surface.color), ("specularIor", 1)]
            return self._add(block("PrincipledMaterial", [*fields, ("specularRoughness", 0), *hidden]))
        fields, textures = dict(surface.fields), dict(surface.textures)
        if surface.emits and not fields.get("transmissionWeight") and not fields.get("subsurfaceWeight"):
            # Surfaces of Blender emit light on both sides.
            fields["walls"] = "thin"
        if surface.opacity.is_constant:
            fields["opacity"] = float(np.clip(surface.opacity.values[0], 0, 1))
        else:
            values = np.clip(surface.opacity.values[..., :1], 0, 1)
            textures["opacityTexture"] = (self.textures.file(np.repeat(values, 3, -1), True), surface.opacity.mapping, ())
        if "normalTexture" in textures or "bumpTexture" in textures:
            # Cycles softens the light on tilted normals too.
            fields["normalShadowing"] = "on"
        named = [(name, self._texture(texture, active, second)) for name, texture in textures.items()]
        return self._add(block("PrincipledMaterial", [*fields.items(), *named, *hidden]))

    def _texture(self, texture, active, second):
        file, mapping, more = texture
        uv_set = 1 if mapping.uv_map and mapping.uv_map != active and mapping.uv_map == second else 0
        if mapping.uv_map and mapping.uv_map not in (active, second):
            self.report.add(f"the UV map {mapping.uv_map} is missing on a mesh: the active one is used")
        (a, b, c), (d, e, f) = mapping.matrix
        words = [("wrapU", mapping.wrap), ("wrapV", mapping.wrap), ("texels", mapping.texels), ("uvSet", uv_set)]
        if mapping.matrix != Mapping.matrix:
            # Rows of the transform with v downwards in both spaces.
            words.append(("uvTransform", ((a, -b, b + c), (-d, e, 1 - e - f))))
        return self.textures.add(file, (*words, *more))
