"""Writes the data of the sky of Hosek and Wilkie that the crates include, from the copy in Mitsuba's wheel:

    pip install mitsuba==3.9.1 numpy
    python xtask/src/sky_data.py

The data is by Lukas Hosek and Alexander Wilkie, under the licence in `crates/durer-scene/src/texture/sky/hosek.LICENSE`.

`texture/sky/hosek.f32`, little-endian single precision:
- the sky, 10 turbidities x 2 albedos x 6 control points x 3 channels x (9 parameters, radiance), unchanged;
- the sun, 10 turbidities x 45 segments of elevation x 3 channels x 4 coefficients of a cubic polynomial: the mean of the
  disc in cd/m^2, which is the spectral radiance times the mean limb darkening, times 683 lm/W and the CIE observer of 1931,
  as linear sRGB.

`mitsuba/sun.f32`: the irradiance of the sun of Mitsuba's RGB variants, measured, 10 turbidities x 30 elevations (2, 5 to 89
degrees) x 3 channels.
"""

import math
import struct
from pathlib import Path

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
CRATES = Path(__file__).resolve().parents[2] / "crates"
SRGB_FROM_XYZ = np.array(
    [[3.2404542, -1.5371385, -0.4985314], [-0.969266, 1.8760108, 0.041556], [0.0556434, -0.2040259, 1.0572252]]
)


def tensors(path):
    """Reads a file of Mitsuba's `TensorFile`: names, shapes and positions of arrays of doubles, then the numbers."""
    data = path.read_bytes()
    (count,) = struct.unpack_from("<I", data, 14)
    at, found = 18, {}
    for _ in range(count):
        (length,) = struct.unpack_from("<H", data, at)
        name = data[at + 2 : at + 2 + length].decode()
        at += 2 + length
        rank, kind, start = struct.unpack_from("<HBQ", data, at)
        assert kind == 11, "not double precision"
        shape = struct.unpack_from(f"<{rank}Q", data, at + 11)
        at += 11 + 8 * rank
        found[name] = np.frombuffer(data, "<f8", math.prod(shape), start).reshape(shape)
    return found


def sun_weights(limb):
    """Linear sRGB in cd/m^2 of each of the 11 wavelengths, between which light and limb darkening are linear."""
    samples = np.arange(320, 721, 40.0)
    # The mean of cos^j over a disc is 2 / (j + 2).
    mean = limb @ [2 / (j + 2) for j in range(6)]
    total = np.zeros((3, 11))
    for nm in np.arange(360, 720.5, 1.0):
        share = np.array([np.interp(nm, samples, row) for row in np.eye(11)])
        observer = np.array([float(x) for x in mi.cie1931_xyz(float(nm))])
        total += np.outer(SRGB_FROM_XYZ @ observer, share * (share @ mean))
    return 683 * total


def measured_sun(turbidity, elevation):
    """Irradiance of Mitsuba's sun, from the radiance of its disc."""
    direction = [math.cos(math.radians(elevation)), 0.0, math.sin(math.radians(elevation))]
    light = mi.load_dict({"type": "sunsky", "turbidity": turbidity, "sun_direction": direction, "sky_scale": 0.0})
    seen = mi.SurfaceInteraction3f()
    seen.wi = -mi.Vector3f(direction)
    solid_angle = 2 * math.pi * (1 - math.cos(math.radians(0.5358 / 2)))
    return [float(x) * solid_angle for x in light.eval(seen)]


data = tensors(Path(mi.__file__).parent / "data/sunsky/sunsky_datasets.bin")
sky = np.concatenate([data["sky_params_rgb"], data["sky_rad_rgb"][..., None]], axis=-1)
sun = np.einsum("cw,tswk->tsck", sun_weights(data["sun_ld_spec"]), data["sun_rad_spec"])
assert sky.shape == (10, 2, 6, 3, 10) and sun.shape == (10, 45, 3, 4)
numbers = np.concatenate([sky.ravel(), sun.ravel()]).astype("<f4")
(CRATES / "durer-scene/src/texture/sky/hosek.f32").write_bytes(numbers.tobytes())
measured = np.array([measured_sun(t, e) for t in range(1, 11) for e in range(2, 90, 3)], "<f4")
(CRATES / "durer-formats/src/mitsuba/sun.f32").write_bytes(measured.tobytes())
