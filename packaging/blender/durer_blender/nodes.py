"""Evaluates the nodes of a material to constants or pictures.

A node that computes colours or numbers from one image texture is evaluated for each of its texels,
so that the result is again a texture.
"""

from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from .units import black_body, luminance, to_linear

#: Largest number of texels of a texture that is computed from others.
MOST_TEXELS = 1 << 26


class Untranslated(Exception):
    """Reason why a socket has no counterpart."""


@dataclass(frozen=True)
class Mapping:
    """Placement of an image on a surface."""

    #: Rows of the transform from the texture coordinates of Blender to those of the image.
    matrix: tuple = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    #: Name of the UV map; empty for the one that is active in renders.
    uv_map: str = ""
    wrap: str = "repeat"
    texels: str = "linear"


@dataclass(frozen=True)
class Field:
    """Values of a socket: a constant of shape (4,), or a picture of shape (height, width, 4) with
    its top row first. Colours are linear."""

    values: np.ndarray
    mapping: Optional[Mapping] = None
    #: sRGB values of an 8-bit image that nothing has changed.
    srgb: Optional[np.ndarray] = None

    @property
    def is_constant(self):
        return self.mapping is None

    def then(self, function):
        """Returns the field of a function of its values."""
        return Field(np.asarray(function(self.values), np.float32), self.mapping)


@dataclass(frozen=True)
class VertexColors:
    """Colours of a mesh, by the name of the attribute; empty for the active one."""

    name: str
    is_constant = False


def constant(value):
    """Returns the field of a number, colour or vector."""
    array = np.ravel(np.asarray(value, np.float32))
    if array.size == 1:
        array = np.repeat(array, 3)
    return Field(np.append(array[:3], array[3] if array.size > 3 else 1).astype(np.float32))


def gray(values):
    """Returns values whose colour channels are all equal to numbers of shape (...)."""
    return np.stack([values, values, values, np.ones_like(values)], -1)


def combine(function, *fields):
    """Returns the field of a function of several fields, whose pictures must have one mapping."""
    mapping, size = None, None
    for field in fields:
        if isinstance(field, VertexColors):
            raise Untranslated("vertex colours are combined with other values")
        if field.mapping is None:
            continue
        if mapping is not None and field.mapping != mapping:
            raise Untranslated("it combines textures with different mappings")
        mapping = field.mapping
        height, width = field.values.shape[:2]
        size = (height, width) if size is None else (max(size[0], height), max(size[1], width))
    values = [field.values if field.mapping is None else _resized(field.values, size) for field in fields]
    result = np.asarray(function(*values), np.float32)
    if mapping is not None:
        result = np.broadcast_to(result, (*size, 4))
    return Field(result, mapping)


def _resized(values, size):
    """Repeats texels until the picture has a size."""
    height, width = values.shape[:2]
    if (height, width) == size:
        return values
    if size[0] * size[1] > MOST_TEXELS:
        raise Untranslated("it combines textures that are too large")
    rows = (np.arange(size[0]) * height) // size[0]
    columns = (np.arange(size[1]) * width) // size[1]
    return values[rows][:, columns]


def follow(socket, stack):
    """Returns the output that an input gets its value from, with the groups around it, or the input
    itself if nothing is connected. Passes reroutes, groups, and muted nodes."""
    for _ in range(1000):
        if not socket.is_linked or socket.links[0].is_muted or not socket.links[0].is_valid:
            return None, socket, stack
        output = socket.links[0].from_socket
        node = output.node
        if node.mute:
            inner = [link.from_socket for link in node.internal_links if link.to_socket == output]
            if not inner:
                return None, socket, stack
            socket = inner[0]
        elif node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.type == "GROUP" and node.node_tree:
            ends = [n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output]
            if not ends:
                raise Untranslated(f"the node group {node.node_tree.name} has no output")
            socket = next(one for one in ends[0].inputs if one.identifier == output.identifier)
            stack = (*stack, node)
        elif node.type == "GROUP_INPUT" and stack:
            socket = next(one for one in stack[-1].inputs if one.identifier == output.identifier)
            stack = stack[:-1]
        else:
            return output, socket, stack
    raise Untranslated("its links form a loop")


def find(node, *names):
    """Returns the first input of a node that has one of the names, or None."""
    for name in names:
        for socket in node.inputs:
            if socket.enabled and socket.name == name:
                return socket
    return None


class Evaluator:
    """Evaluates sockets. `read_image` returns the field of an image, without a mapping."""

    def __init__(self, read_image):
        self.read_image = read_image

    def value(self, socket, stack=()):
        """Returns the field of an input socket, converted to a colour, a vector or a number as the
        socket requires."""
        output, end, inner = follow(socket, stack)
        if output is None:
            if not hasattr(end, "default_value"):
                raise Untranslated("an input without a value is not connected")
            return constant(end.default_value)
        field = self._output(output, inner)
        if isinstance(field, VertexColors):
            return field
        if socket.type == "VALUE" and output.type == "RGBA":
            return field.then(lambda v: gray(luminance(v)))
        if socket.type == "VALUE" and output.type == "VECTOR":
            return field.then(lambda v: gray(v[..., :3].mean(-1)))
        return field

    def _output(self, output, stack):
        node = output.node
        rule = getattr(self, f"_{node.bl_idname}", None)
        if rule is None:
            raise Untranslated(f"the node {node.bl_label} is not translated")
        return rule(node, output, stack)

    def _input(self, node, stack, *names):
        socket = find(node, *names)
        if socket is None:
            raise Untranslated(f"the node {node.bl_label} has no input {names[0]}")
        return self.value(socket, stack)

    def _ShaderNodeRGB(self, node, output, stack):
        return constant(node.outputs[0].default_value)

    def _ShaderNodeValue(self, node, output, stack):
        return constant(node.outputs[0].default_value)

    def _ShaderNodeBlackbody(self, node, output, stack):
        kelvin = self._input(node, stack, "Temperature")
        if not kelvin.is_constant:
            raise Untranslated("the temperature of a Blackbody node varies")
        return constant(black_body(float(kelvin.values[0])))

    def _ShaderNodeVertexColor(self, node, output, stack):
        if output.name == "Alpha":
            raise Untranslated("the alpha of vertex colours is not translated")
        return VertexColors(node.layer_name)

    def _ShaderNodeAttribute(self, node, output, stack):
        if node.attribute_type != "GEOMETRY" or output.name != "Color":
            raise Untranslated("an Attribute node reads something else than vertex colours")
        return VertexColors(node.attribute_name)

    def _ShaderNodeTexImage(self, node, output, stack):
        if node.image is None:
            return constant((1.0, 0.0, 1.0, 1.0))
        if node.projection != "FLAT":
            raise Untranslated(f"the projection {node.projection.lower()} of an image texture is not translated")
        wraps = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "clamp", "MIRROR": "mirror"}
        texels = "nearest" if node.interpolation == "Closest" else "linear"
        matrix, uv_map = self.coordinates(node.inputs["Vector"], stack)
        field = self.read_image(node.image, node.image_user)
        mapping = Mapping(matrix, uv_map, wraps[node.extension], texels)
        if output.name == "Alpha":
            return Field(gray(field.values[..., 3]), mapping)
        return replace(field, mapping=mapping)

    def coordinates(self, socket, stack):
        """Returns the transform of texture coordinates that a vector input applies, as two rows,
        and the name of the UV map."""
        output, _, inner = follow(socket, stack)
        if output is None:
            return Mapping.matrix, ""
        node = output.node
        if node.type == "TEX_COORD" and output.name == "UV":
            return Mapping.matrix, ""
        if node.type == "UVMAP":
            return Mapping.matrix, node.uv_map
        if node.type != "MAPPING":
            raise Untranslated(f"texture coordinates from {node.bl_label} ({output.name}) are not translated")
        matrix, uv_map = self.coordinates(node.inputs["Vector"], inner)
        location, rotation, scale = (self._fixed(node, inner, name) for name in ("Location", "Rotation", "Scale"))
        if np.abs(rotation[:2]).max() > 1e-6:
            raise Untranslated("a Mapping node rotates texture coordinates about x or y")
        c, s = np.cos(rotation[2]), np.sin(rotation[2])
        if node.vector_type == "TEXTURE":
            if (scale[:2] == 0).any():
                raise Untranslated("a Mapping node scales texture coordinates by 0")
            own = np.diag([*(1 / scale[:2]), 1]) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
            own = own @ np.array([[1, 0, -location[0]], [0, 1, -location[1]], [0, 0, 1]])
        elif node.vector_type in ("POINT", "VECTOR"):
            moved = location[:2] if node.vector_type == "POINT" else (0, 0)
            own = np.array([[c, -s, moved[0]], [s, c, moved[1]], [0, 0, 1]]) @ np.diag([*scale[:2], 1])
        else:
            raise Untranslated("a Mapping node of the type Normal is not translated")
        whole = own @ np.array([*matrix, (0.0, 0.0, 1.0)])
        return tuple(tuple(float(x) for x in row) for row in whole[:2]), uv_map

    def _fixed(self, node, stack, name):
        socket = find(node, name)
        if socket is None:
            return np.zeros(3)
        field = self.value(socket, stack)
        if not field.is_constant:
            raise Untranslated(f"the input {name} of a {node.bl_label} node varies")
        return field.values[:3].astype(float)

    def _ShaderNodeMath(self, node, output, stack):
        operations = {
            "ADD": np.add, "SUBTRACT": np.subtract, "MULTIPLY": np.multiply, "MINIMUM": np.minimum, "MAXIMUM": np.maximum,
            "DIVIDE": lambda a, b: np.where(b == 0, 0, a / np.where(b == 0, 1, b)),
            "POWER": lambda a, b: np.where(a < 0, 0, np.power(np.maximum(a, 0), b)),
            "LESS_THAN": lambda a, b: (a < b) * 1.0, "GREATER_THAN": lambda a, b: (a > b) * 1.0,
            "ABSOLUTE": lambda a, b: np.abs(a), "SQRT": lambda a, b: np.sqrt(np.maximum(a, 0)),
            "SINE": lambda a, b: np.sin(a), "COSINE": lambda a, b: np.cos(a), "FRACT": lambda a, b: a - np.floor(a),
            "ROUND": lambda a, b: np.floor(a + 0.5), "FLOOR": lambda a, b: np.floor(a), "CEIL": lambda a, b: np.ceil(a),
            "EXPONENT": lambda a, b: np.exp(np.minimum(a, 80)),
        }  # fmt: skip
        clamp = (lambda v: np.clip(v, 0, 1)) if node.use_clamp else (lambda v: v)
        fields = [self.value(socket, stack) for socket in node.inputs if socket.enabled]
        if node.operation == "MULTIPLY_ADD":
            return combine(lambda a, b, c: clamp(a * b + c), *fields[:3])
        if node.operation not in operations:
            raise Untranslated(f"the operation {node.operation.lower()} of a Math node is not translated")
        function = operations[node.operation]
        return combine(lambda a, b: clamp(function(a, b)), fields[0], fields[1] if len(fields) > 1 else constant(0))

    def _ShaderNodeMix(self, node, output, stack):
        if node.data_type not in ("RGBA", "FLOAT", "VECTOR") or getattr(node, "factor_mode", "UNIFORM") != "UNIFORM":
            raise Untranslated("a Mix node of this type is not translated")
        inputs = [socket for socket in node.inputs if socket.enabled]
        factor, a, b = (self.value(socket, stack) for socket in inputs[:3])
        limit = (lambda t: np.clip(t, 0, 1)) if node.clamp_factor else (lambda t: t)
        how = node.blend_type if node.data_type == "RGBA" else "MIX"
        clamp = node.data_type == "RGBA" and node.clamp_result
        return self._blend(how, limit, clamp, factor, a, b)

    def _ShaderNodeMixRGB(self, node, output, stack):
        factor, a, b = (self.value(node.inputs[name], stack) for name in ("Fac", "Color1", "Color2"))
        return self._blend(node.blend_type, lambda t: np.clip(t, 0, 1), node.use_clamp, factor, a, b)

    def _blend(self, how, limit, clamp, factor, a, b):
        blends = {
            "MIX": lambda a, b: b, "MULTIPLY": lambda a, b: a * b, "ADD": lambda a, b: a + b,
            "SUBTRACT": lambda a, b: a - b, "DIFFERENCE": lambda a, b: np.abs(a - b),
            "SCREEN": lambda a, b: 1 - (1 - a) * (1 - b),
            "OVERLAY": lambda a, b: np.where(a < 0.5, 2 * a * b, 1 - 2 * (1 - a) * (1 - b)),
        }  # fmt: skip
        if how in ("DARKEN", "LIGHTEN"):
            # These two limit the first colour by the second.
            pick = np.minimum if how == "DARKEN" else np.maximum
            blends[how] = pick
        if how not in blends:
            raise Untranslated(f"the blend mode {how.lower()} of a Mix node is not translated")

        def mixed(t, a, b):
            t = limit(t[..., :1])
            values = a + (blends[how](a, b) - a) * t
            return np.clip(values, 0, 1) if clamp else values

        return combine(mixed, factor, a, b)

    def _ShaderNodeInvert(self, node, output, stack):
        factor, color = self._input(node, stack, "Fac", "Factor"), self._input(node, stack, "Color")
        return combine(lambda t, c: c + (1 - 2 * c) * t[..., :1], factor, color)

    def _ShaderNodeGamma(self, node, output, stack):
        color, gamma = self._input(node, stack, "Color"), self._input(node, stack, "Gamma")
        return combine(lambda c, g: np.where(c > 0, np.power(np.maximum(c, 1e-20), g[..., :1]), c), color, gamma)

    def _ShaderNodeBrightContrast(self, node, output, stack):
        names = (("Color",), ("Bright", "Brightness"), ("Contrast",))
        color, bright, contrast = (self._input(node, stack, *name) for name in names)
        return combine(lambda c, b, k: np.maximum((1 + k) * c + b - 0.5 * k, 0), color, bright, contrast)

    def _ShaderNodeHueSaturation(self, node, output, stack):
        names = (("Hue",), ("Saturation",), ("Value",), ("Fac", "Factor"), ("Color",))
        return combine(_hue_saturation, *(self._input(node, stack, *name) for name in names))

    def _ShaderNodeRGBToBW(self, node, output, stack):
        return self._input(node, stack, "Color").then(lambda v: gray(luminance(v)))

    def _ShaderNodeValToRGB(self, node, output, stack):
        ramp = node.color_ramp
        table = np.array([ramp.evaluate(i / 1023) for i in range(1024)], np.float32)

        def look_up(values):
            return table[np.rint(np.clip(values[..., 0], 0, 1) * 1023).astype(int)]

        field = self._input(node, stack, "Fac", "Factor").then(look_up)
        return field.then(lambda v: gray(v[..., 3])) if output.name == "Alpha" else field

    def _ShaderNodeRGBCurve(self, node, output, stack):
        mapping = node.mapping
        mapping.initialize()
        steps = np.linspace(0, 1, 256)
        tables = [[mapping.evaluate(mapping.curves[3], mapping.evaluate(mapping.curves[i], x)) for x in steps] for i in range(3)]

        def bend(t, c):
            bent = np.stack([np.interp(c[..., i], steps, tables[i]) for i in range(3)] + [c[..., 3]], -1)
            return c + (bent - c) * t[..., :1]

        return combine(bend, self._input(node, stack, "Fac", "Factor"), self._input(node, stack, "Color"))

    def _ShaderNodeClamp(self, node, output, stack):
        names = ("Value", "Min", "Max")
        return combine(lambda v, a, b: np.minimum(np.maximum(v, a), b), *(self._input(node, stack, name) for name in names))

    def _ShaderNodeMapRange(self, node, output, stack):
        if node.data_type != "FLOAT" or node.interpolation_type != "LINEAR":
            raise Untranslated("a Map Range node of this type is not translated")
        names = ("Value", "From Min", "From Max", "To Min", "To Max")

        def mapped(v, a, b, c, d):
            share = np.where(b == a, 0, (v - a) / np.where(b == a, 1, b - a))
            return c + (d - c) * (np.clip(share, 0, 1) if node.clamp else share)

        return combine(mapped, *(self._input(node, stack, name) for name in names))

    def _ShaderNodeSeparateColor(self, node, output, stack):
        if getattr(node, "mode", "RGB") != "RGB":
            raise Untranslated("a Separate Color node in another mode than RGB is not translated")
        channel = [socket.name for socket in node.outputs].index(output.name)
        return self.value(node.inputs[0], stack).then(lambda v: gray(v[..., channel]))

    _ShaderNodeSeparateRGB = _ShaderNodeSeparateXYZ = _ShaderNodeSeparateColor

    def _ShaderNodeCombineColor(self, node, output, stack):
        if getattr(node, "mode", "RGB") != "RGB":
            raise Untranslated("a Combine Color node in another mode than RGB is not translated")
        channels = [self.value(socket, stack) for socket in node.inputs[:3]]
        return combine(lambda r, g, b: _joined(r, g, b), *channels)

    _ShaderNodeCombineRGB = _ShaderNodeCombineXYZ = _ShaderNodeCombineColor


def _joined(*channels):
    """Joins the first channel of three arrays to colours."""
    parts = np.broadcast_arrays(*(channel[..., 0] for channel in channels))
    return np.stack([*parts, np.ones_like(parts[0])], -1)


def _hue_saturation(hue, saturation, value, factor, color):
    """Turns the hue of colours, where 0.5 is no change, and scales their saturation and value."""
    rgb = color[..., :3]
    top, low = rgb.max(-1), rgb.min(-1)
    spread = top - low
    safe = np.where(spread == 0, 1, spread)
    r, g, b = (rgb[..., i] for i in range(3))
    turn = np.where(top == r, (g - b) / safe % 6, np.where(top == g, (b - r) / safe + 2, (r - g) / safe + 4)) / 6
    turn = (np.where(spread == 0, 0, turn) + hue[..., 0] + 0.5) % 1
    strength = np.clip(np.where(top == 0, 0, spread / np.where(top == 0, 1, top)) * saturation[..., 0], 0, 1)
    bright = top * value[..., 0]
    parts = np.stack([np.abs(turn * 6 - 3) - 1, 2 - np.abs(turn * 6 - 2), 2 - np.abs(turn * 6 - 4)], -1)
    changed = ((np.clip(parts, 0, 1) - 1) * strength[..., None] + 1) * bright[..., None]
    mixed = rgb + (np.maximum(changed, 0) - rgb) * factor[..., :1]
    return np.concatenate([mixed, color[..., 3:]], -1)


def read_image(image, report):
    """Returns the field of an image of Blender."""
    if image.source in ("TILED", "SEQUENCE", "MOVIE"):
        raise Untranslated(f"the image {image.name} is {'tiled' if image.source == 'TILED' else 'a sequence or a movie'}")
    width, height = image.size
    if width * height == 0 or not image.has_data and not image.pixels:
        raise Untranslated(f"the image {image.name} has no pixels: is its file missing?")
    if width * height > MOST_TEXELS:
        raise Untranslated(f"the image {image.name} is too large")
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(height, width, image.channels)[::-1]
    if image.channels < 4:
        color = values if image.channels == 3 else np.repeat(values[..., :1], 3, -1)
        values = np.concatenate([color, np.ones_like(color[..., :1])], -1)
    space = image.colorspace_settings.name
    if image.is_float or image.colorspace_settings.is_data or space in ("Linear Rec.709", "Linear", "Raw", "Non-Color"):
        return Field(values)
    if space != "sRGB":
        report.add(f"the colour space {space} of the image {image.name} is read as sRGB")
    srgb = values[..., :3]
    return Field(np.concatenate([to_linear(srgb), values[..., 3:]], -1).astype(np.float32), None, srgb)
