"""The render engine: final pictures, and previews in the 3D viewport."""

import time

import bpy
import numpy as np

from . import camera, library
from .pixels import rgba
from .scene import Exporter
from .units import ExportError

#: Passes of Blender, with the name of a pass, its channels, and the picture of Dürer.
PASSES = {
    "Depth": ("use_pass_z", 1, "Z", "VALUE", "position"),
    "Position": ("use_pass_position", 3, "XYZ", "VECTOR", "position"),
    "Normal": ("use_pass_normal", 3, "XYZ", "VECTOR", "normals"),
    "UV": ("use_pass_uv", 3, "UVA", "VECTOR", "uv"),
}
#: Depth of pixels that show no object, as in Cycles.
FAR = 1e10


class Stopped(Exception):
    """Raised when the user stops a render."""


def options(scene, settings, is_preview=False):
    """Returns the options of `World.render` for the settings of a scene."""
    render = scene.render
    given = {
        "integrator": settings.integrator.lower(),
        "bounces": settings.bounces,
        "samples": min(settings.samples, 16) if is_preview else settings.samples,
        "seed": settings.seed,
        "filter": settings.filter.lower().replace("_", "-"),
        "filter_radius": settings.filter_width / 2,
        "color": settings.color.lower(),
    }
    if settings.clamp > 0:
        given["clamp"] = settings.clamp
    if settings.noise_threshold > 0:
        given["noise_threshold"] = settings.noise_threshold
    if settings.time_limit > 0:
        given["time_limit"] = settings.time_limit
    if render.film_transparent:
        given["background"] = "transparent"
    if render.threads_mode == "FIXED":
        given["threads"] = render.threads
    return given


def size(render):
    """Returns the size of a picture in pixels."""
    scale = render.resolution_percentage / 100
    return max(int(render.resolution_x * scale), 1), max(int(render.resolution_y * scale), 1)


class DurerRenderEngine(bpy.types.RenderEngine):
    """Renders with Dürer."""

    bl_idname = "DURER"
    bl_label = "Dürer"
    bl_use_preview = True
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True
    bl_use_spherical_stereo = False
    #: Picture of the viewport that the engine draws, if any.
    preview = None

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for name, (flag, count, channels, kind, _) in PASSES.items():
            if getattr(renderlayer, flag):
                self.register_pass(scene, renderlayer, name, count, channels, kind)

    def __del__(self):
        try:
            if self.preview is not None:
                self.preview.close()
        except ReferenceError:
            pass

    def view_update(self, context, depsgraph):
        from . import viewport

        settings = depsgraph.scene.durer
        given = options(depsgraph.scene_eval, settings)
        viewport.update(self, context, depsgraph, {**given, "samples": settings.preview_samples})

    def view_draw(self, context, depsgraph):
        from . import viewport

        viewport.draw(self, context, depsgraph)

    def render(self, depsgraph):
        self._started = False
        try:
            self._render(depsgraph)
        except Stopped:
            pass
        except ExportError as error:
            self._fail(str(error), depsgraph)
        except Exception as error:
            # Errors of the package have texts for users, others are bugs with a trace.
            if type(error).__module__.partition(".")[0] != "durer":
                import traceback

                traceback.print_exc()
            self._fail(str(error) or type(error).__name__, depsgraph)

    def _fail(self, text, depsgraph):
        if not self._started:
            # Blender crashes if it has to save a picture that was never begun.
            width, height = size(depsgraph.scene_eval.render)
            self.end_result(self.begin_result(0, 0, width, height, layer=depsgraph.view_layer_eval.name), cancel=True)
        self.report({"ERROR"}, f"Dürer: {text}")

    def _check(self):
        if self.test_break():
            raise Stopped

    def _render(self, depsgraph):
        durer = library.package()
        scene = depsgraph.scene_eval
        render, settings = scene.render, depsgraph.scene.durer
        full = size(render)
        if abs(render.pixel_aspect_x - render.pixel_aspect_y) > 1e-6:
            raise ExportError("pixels must be square: set the aspect of the output to 1 by 1")
        if scene.camera is None:
            raise ExportError("the scene has no camera")
        self.update_stats("", "Reading the scene")
        export = Exporter(depsgraph).run(self.test_break)
        if export is None:
            raise Stopped
        item = scene.camera.evaluated_get(depsgraph)
        view = camera.view(item, item.matrix_world, full, export.report)
        if not self.is_preview:
            for line in export.report.lines():
                self.report({"WARNING"}, f"Dürer: {line}")
        self._check()
        self.update_stats("", "Preparing")
        world = export.world(durer, view)
        self._check()
        self._pictures(durer, world, view, full, depsgraph, options(scene, settings, self.is_preview), settings)

    def _pictures(self, durer, world, view, full, depsgraph, given, settings):
        render, layer = depsgraph.scene_eval.render, depsgraph.view_layer_eval
        passes = {name: row for name, row in PASSES.items() if getattr(layer, row[0])}
        shown = ["color", *dict.fromkeys(row[4] for row in passes.values())]
        box = (0, 0, *full)
        if render.use_border:
            left, right = (min(max(int(x * full[0]), 0), full[0]) for x in (render.border_min_x, render.border_max_x))
            low, high = (min(max(int(y * full[1]), 0), full[1]) for y in (render.border_min_y, render.border_max_y))
            box = (left, full[1] - high, right - left, high - low)
            if box[2] < 1 or box[3] < 1:
                raise ExportError("the render region is empty")
            given["crop"] = box
        self._started = True
        result = self.begin_result(0, 0, box[2], box[3], layer=layer.name)
        samples = given["samples"]
        start = time.monotonic()

        def watch(done, total):
            self._check()
            share = done / max(total, 1)
            self.update_progress(share)
            self.update_stats("", f"Sample {min(int(share * samples) + 1, samples)} of {samples}")

        def show(pictures):
            self._fill(result, pictures, view, passes)
            self.update_result(result)

        finished = False
        try:
            part = world.part(size=full, show=shown, **given)
            every = 0.5 if time.monotonic() - start < 1 else 2.0
            pictures = world.render(part=part, progress=watch, callback=show, every=every, **_work(given))
            self._fill(result, pictures, view, passes)
            if settings.denoise and not self.is_preview:
                self.update_stats("", "Denoising")
                self._fill(result, {**pictures, "color": world.denoise(pictures)["denoised"]}, view, passes)
            finished = True
        finally:
            self.end_result(result, cancel=not finished and not self.test_break())

    def _fill(self, result, pictures, view, passes):
        """Copies pictures to the passes of a result. Blender has the bottom row first."""
        layer = result.layers[0]
        _set(layer, "Combined", rgba(pictures))
        for name, (_, _, _, _, source) in passes.items():
            _set(layer, name, _pass(name, pictures[source], view))


def _work(given):
    """Returns the options that do not change the picture."""
    return {name: value for name, value in given.items() if name == "threads"}


def _pass(name, values, view):
    if name == "UV":
        return np.concatenate([values[..., :2], (values != 0).any(-1, keepdims=True)], -1)
    own = np.stack([values[..., 0], -values[..., 2], values[..., 1]], -1)
    if name == "Depth":
        hit = (values != 0).any(-1)
        off = own - np.asarray(view.center, np.float32)
        depth = np.linalg.norm(off, axis=-1) if view.axis is None else off @ np.asarray(view.axis, np.float32)
        return np.where(hit, depth, FAR)[..., None]
    return own


def _set(layer, name, values):
    target = layer.passes.get(name)
    if target is not None:
        target.rect.foreach_set(np.ascontiguousarray(values[::-1], np.float32).ravel())
