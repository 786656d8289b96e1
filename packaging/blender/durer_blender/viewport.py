"""Previews in the 3D viewport. The scene is read again after each change, and rendered in a thread
that adds samples to the picture until the view changes."""

import threading

import bpy
import gpu
import numpy as np
from gpu_extras.presets import draw_texture_2d

from . import camera, library
from .pixels import rgba
from .scene import Exporter
from .units import ExportError

#: Seconds between two checks for a new picture.
INTERVAL = 0.1


class _Stopped(Exception):
    pass


class Preview:
    """Picture of a viewport. A timer of Blender asks for a redraw when it changes."""

    def __init__(self, engine):
        self.engine = engine
        self.export, self.view, self.size, self.options = None, "", (0, 0), {}
        self.picture, self.message = None, "Dürer"
        self._is_new, self._stop, self._thread = False, threading.Event(), None
        self._timer = self._look
        bpy.app.timers.register(self._timer, first_interval=INTERVAL)

    def close(self):
        """Stops the thread and the timer."""
        self._halt()
        if bpy.app.timers.is_registered(self._timer):
            bpy.app.timers.unregister(self._timer)

    def read(self, depsgraph, options):
        """Reads the scene again. Runs in Blender's main thread, which owns the scene."""
        self._halt()
        self.export, self.options, self.view = Exporter(depsgraph).run(), options, ""

    def show(self, view, size):
        """Starts to render a view unless it is the current one."""
        if self.export is None or (view.text, size) == (self.view, self.size):
            return
        self._halt()
        self.view, self.size = view.text, size
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._render, args=(self.export, view, size, self.options, self._stop), daemon=True)
        self._thread.start()

    def _halt(self):
        self._stop.set()
        if self._thread is not None:
            self._thread.join()
            self._thread = None

    def _render(self, export, view, size, options, stop):
        def watch(done, total):
            if stop.is_set():
                raise _Stopped

        def take(pictures):
            self.picture, self._is_new = rgba(pictures)[::-1], True

        try:
            durer = library.package()
            world = export.world(durer, view)
            watch(0, 1)
            take(world.render(size=size, progress=watch, callback=take, every=0.2, **options))
            self.message = f"{options['samples']} samples"
        except _Stopped:
            pass
        except Exception as error:
            self.message = str(error)
        self._is_new = True

    def _look(self):
        try:
            if self._is_new:
                self._is_new = False
                self.engine.update_stats("", self.message)
                self.engine.tag_redraw()
        except ReferenceError:
            # Blender has removed the engine.
            self._halt()
            return None
        return INTERVAL

    def draw(self, region):
        """Draws the picture so far, stretched to the region."""
        picture = self.picture
        if picture is None:
            return
        height, width = picture.shape[:2]
        pixels = gpu.types.Buffer("FLOAT", width * height * 4, np.ascontiguousarray(picture, np.float32).ravel())
        texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=pixels)
        draw_texture_2d(texture, (0, 0), region.width, region.height)


def update(engine, context, depsgraph, options):
    """Handles a change of the scene."""
    if engine.preview is None:
        engine.preview = Preview(engine)
    try:
        engine.preview.read(depsgraph, options)
    except ExportError as error:
        engine.update_stats("", str(error))


def draw(engine, context, depsgraph):
    """Draws the viewport, and starts to render if the view has changed."""
    if engine.preview is None:
        return
    try:
        view, size = camera.region_view(context.region, context.space_data, context.region_data)
        engine.preview.show(view, size)
    except ExportError as error:
        engine.update_stats("", str(error))
    engine.bind_display_space_shader(depsgraph.scene)
    gpu.state.blend_set("ALPHA_PREMULT")
    engine.preview.draw(context.region)
    engine.unbind_display_space_shader()
    gpu.state.blend_set("NONE")
