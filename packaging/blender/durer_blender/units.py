"""Formulas that convert Blender's quantities to Dürer's. Needs neither Blender nor Dürer.

Blender has z up and Dürer has y up: a point (x, y, z) of Blender is (x, z, -y) in Dürer.
"""

from math import acos, atan, atan2, cos, degrees, pi

import numpy as np

#: Rotation from Blender's axes to Dürer's.
TO_DURER = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])


class ExportError(Exception):
    """Error in the scene that Blender gave, in words for the user."""


def number(value):
    """Formats a number for the scene language."""
    value = float(value)
    # Dürer computes in single precision.
    if not abs(value) <= np.finfo(np.float32).max:
        raise ExportError(f"the scene contains the number {value}, which cannot be rendered")
    return format(value, ".9g")


def numbers(values):
    """Formats numbers, separated by spaces."""
    return " ".join(number(value) for value in values)


def block(word, fields):
    """Returns a block of the scene language. `fields` are pairs of a name and a number, several
    numbers, or a text. Pairs with None are left out."""
    parts = [word, "{"]
    for name, value in fields:
        if value is None:
            continue
        if isinstance(value, str):
            parts.append(f"{name} {value}")
        elif np.ndim(value) == 0:
            parts.append(f"{name} {number(value)}")
        elif np.ndim(value) == 1:
            parts.append(f"{name} {numbers(value)}")
        else:
            parts.append(f"{name} {{ {'  '.join(numbers(row) for row in value)} }}")
    return " ".join([*parts, "}"])


def placed(matrix, item):
    """Returns an object in the scene language with a transform from its own space to the world of
    Blender."""
    rows = (TO_DURER @ np.asarray(matrix, float)).reshape(4, 4)
    text = "  ".join(numbers(row) for row in rows[:3])
    return f"Transform {{ Matrix {{ {text}  0 0 0 1 }} {item} }}"


def point(vector):
    """Converts a point or direction of Blender."""
    x, y, z = (float(value) for value in vector[:3])
    return (x, z, -y)


# Light. In Dürer, the colour of a light without extent is the irradiance divided by pi, on a
# surface that faces the light, at distance 1 for a light with a position.


def point_strength(watts):
    """Strength of a point light or a spotlight of Blender, whose intensity is the power divided by
    4 pi, also for a spotlight with a narrow cone."""
    return watts / (4 * pi * pi)


def sphere_radiance(watts, radius):
    """Radiance of a point light with a radius: a sphere that emits its power equally."""
    return watts / (4 * pi * pi * radius * radius)


def area_radiance(watts, area):
    """Radiance of an area light, which emits its power on one side."""
    return watts / (pi * area)


def sun_strength(irradiance):
    """Strength of a sun, whose strength in Blender is its irradiance."""
    return irradiance / pi


def spot_angles(size, blend):
    """Angles in degrees from the axis of a spotlight to the edge of its cone, and to where the fade
    begins. `size` is the full angle of the cone in radians. The fade of Blender is smooth over a
    share `blend` of the range of the cosine."""
    edge = cos(size / 2)
    return degrees(size / 2), degrees(acos(min(1.0, edge + (1 - edge) * blend)))


def disc_points(count):
    """Points of equal density in the unit disc, as rows of x and y, in a spiral of golden angles."""
    i = np.arange(count)
    radius, angle = np.sqrt((i + 0.5) / count), i * pi * (3 - 5**0.5)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], 1)


# Cameras.


def fitted_side(width, height, fit):
    """Length in pixels of the side of the picture that the sensor's size refers to."""
    is_wide = width >= height if fit == "AUTO" else fit == "HORIZONTAL"
    return width if is_wide else height


def view_angle(lens, sensor, width, height, fit):
    """Field of view in degrees across the larger side of the picture. `lens` and `sensor` are the
    focal length and the sensor's size in equal units."""
    half = 0.5 * sensor / lens * max(width, height) / fitted_side(width, height, fit)
    return degrees(2 * atan(half))


def film_shift(shift, width, height, fit):
    """Converts a shift of the sensor, in units of its fitted side, to units of half the larger side
    of the picture."""
    return 2 * shift * fitted_side(width, height, fit) / max(width, height)


# Colours.


def luminance(colors):
    """Luminance of linear Rec.709 colours, in the last axis."""
    return colors[..., 0] * 0.2126 + colors[..., 1] * 0.7152 + colors[..., 2] * 0.0722


def to_linear(values):
    """Converts sRGB values to linear light."""
    values = np.asarray(values, np.float32)
    return np.where(values <= 0.04045, values / 12.92, ((np.maximum(values, 0.04045) + 0.055) / 1.055) ** 2.4)


def metal_edge(color):
    """Edge colour with which a metal of OpenPBR reflects its colour on average, as it does at all
    angles for Blender's glossy shader, which has no Fresnel term.

    The reflectance at the cosine m is F0 + (1 - F0) (1 - m)^5 - b m (1 - m)^6, so its mean, weighted
    by 2 m, is F0 + (1 - F0) / 21 - b / 126. The edge colour is the ratio of the reflectance to that
    without the last term at m = 1/7."""
    color = np.clip(np.asarray(color, float), 0, 1)
    without = color + (1 - color) * (6 / 7) ** 5
    return (without - 6 * (1 - color) * (6 / 7) ** 6 / 7) / without


def stretched(ratio):
    """Factor on the roughness of a surface whose highlight is `ratio` times as wide in one direction
    as in the other. In Blender, the geometric mean of both widths stays constant, and in OpenPBR
    their root mean square."""
    ratio = min(max(ratio, 1e-3), 1.0)
    return ((1 + ratio * ratio) / (2 * ratio)) ** 0.25


def black_body(kelvin):
    """Linear Rec.709 colour of a black body with a luminance of 1, after Planck's law and the fits
    of Wyman, Sloan and Shirley (2013) to the colour matching functions."""

    def lobe(wave, centre, below, above):
        return np.exp(-0.5 * ((wave - centre) / np.where(wave < centre, below, above)) ** 2)

    wave = np.arange(380.0, 781.0, 5.0)
    x = 1.056 * lobe(wave, 599.8, 37.9, 31.0) + 0.362 * lobe(wave, 442.0, 16.0, 26.7) - 0.065 * lobe(wave, 501.1, 20.4, 26.2)
    y = 0.821 * lobe(wave, 568.8, 46.9, 40.5) + 0.286 * lobe(wave, 530.9, 16.3, 31.1)
    z = 1.217 * lobe(wave, 437.0, 11.8, 36.0) + 0.681 * lobe(wave, 459.0, 26.0, 13.8)
    light = 1 / (wave**5 * (np.exp(np.minimum(1.4388e7 / (wave * max(kelvin, 500.0)), 600)) - 1))
    xyz = np.array([(light * weight).sum() for weight in (x, y, z)])
    to_rgb = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])
    return np.maximum(to_rgb @ (xyz / xyz[1]), 0)


def turn_about_up(matrix):
    """Angle in degrees of a rotation about Blender's z axis, or None for another rotation."""
    matrix = np.asarray(matrix, float)
    if abs(matrix[2, 2] - 1) > 1e-6:
        return None
    return degrees(atan2(matrix[1, 0], matrix[0, 0]))
