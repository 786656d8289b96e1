"""Dürer as a render engine of Blender."""

import bpy

from . import engine, panels, properties


def register():
    properties.register()
    bpy.utils.register_class(engine.DurerRenderEngine)
    panels.register()


def unregister():
    panels.unregister()
    bpy.utils.unregister_class(engine.DurerRenderEngine)
    properties.unregister()
