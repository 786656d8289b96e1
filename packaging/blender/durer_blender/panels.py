"""Panels of the settings, and the panels of Blender that apply to Dürer."""

import bpy

#: Panels of Blender's own engines that show what Dürer reads.
SHARED = (
    "EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface", "EEVEE_WORLD_PT_surface", "DATA_PT_EEVEE_light",
    "DATA_PT_light", "DATA_PT_EEVEE_light_distance", "DATA_PT_spot", "DATA_PT_area", "MATERIAL_PT_preview",
)  # fmt: skip
#: Generic panels of settings that Dürer does not have.
UNUSED = {"RENDER_PT_freestyle", "RENDER_PT_simplify_viewport", "VIEWLAYER_PT_filter", "DATA_PT_shadow"}


class _Panel:
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "render"
    COMPAT_ENGINES = {"DURER"}

    @classmethod
    def poll(cls, context):
        return context.engine == "DURER"

    def show(self, context, *names):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in names:
            self.layout.prop(context.scene.durer, name)


class DURER_PT_sampling(_Panel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw(self, context):
        self.show(context, "samples", "preview_samples", "noise_threshold", "time_limit", "seed", "denoise")


class DURER_PT_light(_Panel, bpy.types.Panel):
    bl_label = "Light Paths"

    def draw(self, context):
        self.show(context, "integrator", "bounces", "clamp", "color")


class DURER_PT_film(_Panel, bpy.types.Panel):
    bl_label = "Film"

    def draw(self, context):
        self.show(context, "filter", "filter_width")
        self.layout.prop(context.scene.render, "film_transparent")


class DURER_PT_threads(_Panel, bpy.types.Panel):
    bl_label = "Threads"

    def draw(self, context):
        render = context.scene.render
        self.layout.use_property_split = True
        self.layout.prop(render, "threads_mode")
        row = self.layout.row()
        row.enabled = render.threads_mode == "FIXED"
        row.prop(render, "threads")


PANELS = (DURER_PT_sampling, DURER_PT_light, DURER_PT_film, DURER_PT_threads)


def _shared():
    """Returns the panels of Blender that are shown for Dürer."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is not None and panel.__name__ not in UNUSED and ("BLENDER_RENDER" in engines or panel.__name__ in SHARED):
            yield panel


def register():
    for panel in PANELS:
        bpy.utils.register_class(panel)
    for panel in _shared():
        panel.COMPAT_ENGINES.add("DURER")


def unregister():
    for panel in _shared():
        panel.COMPAT_ENGINES.discard("DURER")
    for panel in reversed(PANELS):
        bpy.utils.unregister_class(panel)
