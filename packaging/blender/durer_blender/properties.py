"""Settings of a scene."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty


class DurerSettings(bpy.types.PropertyGroup):
    """Settings of Dürer for a scene."""

    samples: IntProperty(name="Samples", description="Samples for each pixel of a final picture", default=256, min=1, soft_max=4096)
    preview_samples: IntProperty(name="Viewport", description="Samples for each pixel of the 3D viewport", default=32, min=1)
    noise_threshold: FloatProperty(
        name="Noise Threshold",
        description="Stop sampling a pixel when its error in display values is below this; 0 takes all samples",
        default=0, min=0, max=1, precision=4,
    )  # fmt: skip
    time_limit: FloatProperty(name="Time Limit", description="Stop after this time; 0 for no limit", default=0, min=0, unit="TIME_ABSOLUTE")
    integrator: EnumProperty(
        name="Integrator",
        items=[
            ("PATH", "Path Tracing", "Light by any number of bounces"),
            ("PHOTONS", "Photons", "Path tracing with a photon map, for the caustics of glass and mirrors"),
            ("WHITTED", "Whitted", "Direct light, mirrors and glass only"),
            ("AO", "Ambient Occlusion", "The share of the surroundings that each point sees"),
        ],
        default="PATH",
    )
    bounces: IntProperty(name="Bounces", description="Largest number of bounces after the first hit", default=12, min=0, max=1024)
    clamp: FloatProperty(
        name="Clamp", description="Largest brightness of one contribution after a bounce, against fireflies; 0 for no limit", default=0, min=0
    )
    color: EnumProperty(
        name="Light",
        items=[("RGB", "RGB", "Three colour channels"), ("SPECTRAL", "Spectral", "Four wavelengths for each path")],
        default="RGB",
    )
    filter: EnumProperty(
        name="Pixel Filter",
        items=[
            ("BLACKMAN_HARRIS", "Blackman-Harris", "Smooth, as in Cycles"),
            ("GAUSSIAN", "Gaussian", "A Gaussian"),
            ("BOX", "Box", "The mean of the pixel"),
        ],
        default="BLACKMAN_HARRIS",
    )
    filter_width: FloatProperty(name="Width", description="Width of the filter in pixels", default=1.5, min=0.1, max=10)
    seed: IntProperty(name="Seed", description="Seed of the random numbers", default=0, min=0)
    denoise: BoolProperty(name="Denoise", description="Remove noise from the finished picture with Dürer's own denoiser", default=False)


def register():
    bpy.utils.register_class(DurerSettings)
    bpy.types.Scene.durer = PointerProperty(type=DurerSettings)


def unregister():
    del bpy.types.Scene.durer
    bpy.utils.unregister_class(DurerSettings)
