"""Translates a scene of Blender to the scene language."""

from dataclasses import dataclass

import numpy as np

from . import meshes
from .camera import View
from .lights import Lights
from .materials import Materials
from .pixels import Textures
from .report import Report
from .units import block, placed
from .world import background

#: Types of objects with surfaces that Blender converts to meshes.
SURFACES = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
#: Types of objects that are never visible.
INVISIBLE = {"EMPTY", "CAMERA", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"}


@dataclass
class Export:
    """A scene without its camera, as text of the scene language, with the files that it uses."""

    text: str
    files: dict
    report: Report

    def world(self, durer, view: View):
        """Returns the scene as a world of Dürer, seen by a camera."""
        return durer.World.from_text(f"{view.text}\n{self.text}", files=self.files, dialect="durer")


class Exporter:
    """Collects the objects of a scene."""

    def __init__(self, depsgraph):
        self.depsgraph = depsgraph
        self.report, self.textures = Report(), Textures()
        self.materials = Materials(self.textures, self.report)
        self.lights = Lights(self.materials, self.report)
        self.files, self.definitions, self.objects = {}, [], []
        #: Parts of each mesh, with the materials of its slots.
        self._meshes = {}

    def run(self, is_stopped=lambda: False):
        """Returns the export, or None if it was stopped."""
        scene = self.depsgraph.scene_eval
        for number, instance in enumerate(self.depsgraph.object_instances):
            if number % 64 == 0 and is_stopped():
                return None
            self._instance(instance)
        if scene.render.use_motion_blur:
            self.report.add("motion blur is not rendered")
        view_layer = self.depsgraph.view_layer_eval
        override = getattr(view_layer, "material_override", None)
        if override is not None:
            self.report.add("the material override of the view layer is ignored")
        parts = [background(scene.world, self.textures, self.report)]
        parts.append("Lights {\n" + "\n".join(self.lights.blocks) + "\n}")
        # A scene needs a material, even without objects.
        self.materials.number(None)
        blocks = [block("Texture", [("name", name), ("picture", file), *words]) for name, file, words in self.textures.blocks]
        parts += ["Textures {\n" + "\n".join(blocks) + "\n}"] if blocks else []
        parts.append("Materials {\n" + "\n".join(self.materials.texts) + "\n}")
        objects = self.objects + [f"MaterialIndex {number} {item}" for number, item in self.lights.objects]
        parts += [*self.definitions, "Group {\n" + "\n".join(objects) + "\n}", ""]
        return Export("\n".join(parts), {**self.files, **self.textures.files}, self.report)

    def _instance(self, instance):
        item = instance.object
        if not instance.show_self or item.type in INVISIBLE:
            return
        matrix = np.array(instance.matrix_world, float)
        if item.type == "LIGHT":
            self.lights.add(item, matrix)
        elif item.type in SURFACES:
            self._surface(item, matrix)
        else:
            self.report.add(f"objects of the type {item.type.lower()} are not rendered, such as {item.name}")

    def _surface(self, item, matrix):
        for name in ("is_holdout", "is_shadow_catcher"):
            if getattr(item, name, False):
                self.report.add(f"object {item.name}: {name.replace('is_', '').replace('_', ' ')}s are rendered as surfaces")
        rays = ("diffuse", "glossy", "transmission", "shadow")
        if not all(getattr(item, f"visible_{name}", True) for name in rays):
            self.report.add(f"object {item.name}: only the visibility for the camera is translated, not that for other rays")
        if item.particle_systems and any(system.settings.render_type == "PATH" for system in item.particle_systems):
            self.report.add(f"object {item.name}: hair is not rendered")
        known = self._mesh(item)
        if known is None:
            return
        parts, slots, active, second = known
        if parts and abs(np.linalg.det(matrix[:3, :3])) < 1e-30:
            self.report.add(f"object {item.name} has a scale of 0 and is not rendered")
            return
        unseen = not item.visible_camera
        for part in parts:
            material = slots[part.slot] if part.slot < len(slots) else None
            number = self.materials.number(material, active, second, unseen)
            self.objects.append(f"MaterialIndex {number} {placed(matrix, f'use {part.file[:-4]}')}")

    def _mesh(self, item):
        """Returns the parts of an object's mesh, its materials, and its UV maps."""
        own = [slot.material for slot in item.material_slots]
        key = (item.data.as_pointer() if item.type == "MESH" else item.as_pointer(), tuple(m and m.name_full for m in own))
        if key not in self._meshes:
            mesh = item.to_mesh()
            if mesh is None:
                self._meshes[key] = None
                return None
            try:
                self._meshes[key] = self._written(mesh, own, f"mesh{len(self._meshes)}")
            finally:
                item.to_mesh_clear()
        return self._meshes[key]

    def _written(self, mesh, own, name):
        # Instances of geometry nodes have the slots of another object.
        slots = [m or own[i] if i < len(own) else m for i, m in enumerate(mesh.materials)] or own
        slots = [own[i] if i < len(own) and own[i] is not None else m for i, m in enumerate(slots)]
        wanted = [uv for material in slots for uv in self.materials.uv_maps(material)]
        active = meshes.active_uv(mesh)
        second = meshes.second_uv(mesh, active, wanted)

        def colors_of(slot):
            found = self.materials.colors(slots[slot]) if slot < len(slots) else None
            return None if found is None else found.name

        parts = meshes.write(mesh, name, second, colors_of, self.files)
        for part in parts:
            shape = block("TriangleMesh", [("obj_file", part.file)])
            self.definitions.append(f"define {part.file[:-4]} {shape}")
        return parts, slots, active, second
