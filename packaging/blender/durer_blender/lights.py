"""Lights: those of Blender as lights without extent, or as surfaces that emit light and that the
camera does not see."""

from math import pi

import numpy as np

from .nodes import Evaluator, Untranslated, VertexColors, read_image
from .units import (
    area_radiance, block, disc_points, placed, point, point_strength, sphere_radiance, spot_angles, sun_strength
)  # fmt: skip

#: Number of spotlights without extent that replace a spotlight with a radius.
SPOTS = 32


class Lights:
    """Lights of a scene."""

    def __init__(self, materials, report):
        self.materials, self.report = materials, report
        #: Blocks of lights without extent.
        self.blocks = []
        #: Objects with the number of their material.
        self.objects = []

    def add(self, item, matrix):
        """Adds a light object of Blender with its transform."""
        light = item.data
        if light.type == "AREA" and getattr(getattr(light, "cycles", None), "is_portal", False):
            # Portals only guide the sampling of Cycles.
            return
        if not light.use_shadow:
            self.lost(light, "it casts shadows here")
        matrix = np.array(matrix, float)
        power = np.array(light.color[:3], float) * light.energy * 2 ** getattr(light, "exposure", 0)
        if getattr(light, "use_temperature", False):
            power *= np.array(light.temperature_color[:3])
        power *= self._nodes(light)
        if getattr(light, "normalize", True) is False:
            power *= self._unit(light, matrix)
        if not (power > 0).any():
            return
        getattr(self, f"_{light.type.lower()}")(light, matrix, power)

    def lost(self, light, text):
        self.report.add(f"light {light.name}: {text}")

    def _nodes(self, light):
        """Returns the colour times the strength of the nodes of a light."""
        tree = light.node_tree if getattr(light, "use_nodes", True) else None
        end = tree.get_output_node("CYCLES") or tree.get_output_node("ALL") if tree else None
        if end is None or not end.inputs["Surface"].is_linked:
            return np.ones(3)
        node = end.inputs["Surface"].links[0].from_node
        if node.bl_idname != "ShaderNodeEmission":
            self.lost(light, f"the node {node.bl_label} is not translated")
            return np.ones(3)
        evaluator, found = Evaluator(lambda image, user: read_image(image, self.report)), []
        for name in ("Color", "Strength"):
            try:
                value = evaluator.value(node.inputs[name])
                if isinstance(value, VertexColors) or not value.is_constant:
                    raise Untranslated(f"{name} is not constant")
                found.append(value.values[:3].astype(float))
            except Untranslated as reason:
                self.lost(light, f"{reason}: the node's own value is used")
                found.append(np.ones(3))
        return found[0] * found[1]

    def _unit(self, light, matrix):
        """Returns the factor on the power of a light whose power is that of each unit of area, or of
        solid angle for a sun."""
        if light.type == "AREA":
            return self._area_of(light, matrix)
        if light.type == "SUN":
            return 2 * pi * (1 - np.cos(light.angle / 2)) or 1.0
        return 4 * pi * light.shadow_soft_size**2 or 1.0

    def _point(self, light, matrix, power):
        radius = light.shadow_soft_size
        if radius <= 0:
            fields = [("position", point(matrix[:3, 3])), ("color", point_strength(power)), ("attenuation", (0, 0, 1))]
            self.blocks.append(block("PointLight", fields))
            return
        sphere = block("Sphere", [("center", point(matrix[:3, 3])), ("radius", radius)])
        self.objects.append((self.materials.light(sphere_radiance(power, radius)), sphere))

    def _spot(self, light, matrix, power):
        edge, inner = spot_angles(light.spot_size, light.spot_blend)
        axis, places, radius = -matrix[:3, 2], [matrix[:3, 3]], light.shadow_soft_size
        if radius > 0:
            across = [matrix[:3, i] / np.linalg.norm(matrix[:3, i]) for i in range(2)]
            places = [matrix[:3, 3] + radius * (x * across[0] + y * across[1]) for x, y in disc_points(SPOTS)]
            self.lost(light, f"a spotlight with a radius becomes {SPOTS} spotlights without one")
        scale = np.linalg.norm(matrix[:3, :3], axis=0)
        if scale.max() > 1.001 * scale.min():
            self.lost(light, "the cone of a scaled spotlight stays round")
        for place in places:
            fields = [("position", point(place)), ("direction", point(axis)), ("color", point_strength(power) / len(places))]
            fields += [("angle", edge), ("innerAngle", min(inner, edge)), ("fade", "smooth")]
            self.blocks.append(block("SpotLight", fields))

    def _sun(self, light, matrix, power):
        fields = [("direction", point(-matrix[:3, 2])), ("color", sun_strength(power))]
        half = np.degrees(light.angle / 2)
        self.blocks.append(block("DirectionalLight", [*fields, ("spread", half if half > 0 else None)]))

    def _sides(self, light):
        """Returns the lengths of an area light along its own axes."""
        is_even = light.shape in ("SQUARE", "DISK")
        return light.size, light.size if is_even else light.size_y

    def _area_of(self, light, matrix):
        x, y = self._sides(light)
        across = np.linalg.norm(np.cross(matrix[:3, 0], matrix[:3, 1]))
        return x * y * across * (pi / 4 if light.shape in ("DISK", "ELLIPSE") else 1)

    def _area(self, light, matrix, power):
        x, y = self._sides(light)
        area = self._area_of(light, matrix)
        if area <= 0:
            self.lost(light, "its area is 0: it gives no light")
            return
        if light.spread < pi - 1e-3:
            self.lost(light, "the spread of area lights is not translated: it emits light in all directions in front")
        # Area lights of Blender face the negative z axis.
        if light.shape in ("DISK", "ELLIPSE"):
            sized = matrix @ np.diag([x / 2, y / 2, (x + y) / 4, 1])
            item = placed(sized, block("Disc", [("center", (0, 0, 0)), ("normal", (0, 0, -1)), ("radius", 1)]))
        else:
            corner, across, up = matrix @ (-x / 2, -y / 2, 0, 1), matrix @ (x, 0, 0, 0), matrix @ (0, y, 0, 0)
            # A mirrored transform would turn the front to the other side.
            first, second = (up, across) if np.linalg.det(matrix[:3, :3]) > 0 else (across, up)
            item = block("Rectangle", [("corner", point(corner)), ("edge0", point(first)), ("edge1", point(second))])
        self.objects.append((self.materials.light(area_radiance(power, area)), item))
