"""The world of Blender as the background of Dürer."""

import numpy as np

from .nodes import Evaluator, Field, Mapping, Untranslated, combine, find, follow, read_image
from .units import block, turn_about_up


def background(world, textures, report):
    """Returns the background as text of the scene language."""
    if world is None:
        return block("Background", [("color", (0, 0, 0))])
    if getattr(getattr(world, "cycles_visibility", None), "camera", True) is False:
        report.add(f"world {world.name}: the camera sees the background")
    tree = world.node_tree if getattr(world, "use_nodes", True) else None
    if tree is None:
        return block("Background", [("color", tuple(world.color[:3]))])
    try:
        return _of_nodes(tree, textures, report, world.name)
    except Untranslated as reason:
        color = tuple(world.color[:3])
        report.add(f"world {world.name}: {reason}: the background has its viewport colour")
        return block("Background", [("color", color)])


def _of_nodes(tree, textures, report, name):
    end = tree.get_output_node("CYCLES") or tree.get_output_node("ALL")
    if end is None:
        return block("Background", [("color", (0, 0, 0))])
    if end.inputs["Volume"].is_linked:
        report.add(f"world {name}: volumes are not translated")
    output, _, stack = follow(end.inputs["Surface"], ())
    if output is None:
        return block("Background", [("color", (0, 0, 0))])
    node = output.node
    if node.bl_idname not in ("ShaderNodeBackground", "ShaderNodeEmission"):
        raise Untranslated(f"the shader {node.bl_label} is not translated")
    reader = _EnvironmentReader(report)
    color, strength = reader.value(node.inputs["Color"], stack), reader.value(node.inputs["Strength"], stack)
    light = combine(lambda c, s: np.maximum(c * s[..., :1], 0), color, strength)
    if light.is_constant:
        return block("Background", [("color", light.values[:3])])
    values, turn = light.values[..., :3], light.mapping.matrix[0][2]
    file = textures.file(values.astype(np.float32), False)
    # The centre of the map is at +x in Blender and at -z in Dürer.
    return block("Background", [("environment", file), ("environmentRotation", 90 - turn)])


class _EnvironmentReader(Evaluator):
    """Evaluates the nodes of a world. The mapping of a field holds the angle in degrees by which
    the environment is turned about the up axis."""

    def __init__(self, report):
        super().__init__(lambda image, user: read_image(image, report))

    def _ShaderNodeTexEnvironment(self, node, output, stack):
        if node.image is None:
            raise Untranslated("an environment texture has no image")
        if node.projection != "EQUIRECTANGULAR":
            raise Untranslated("environment textures of mirror balls are not translated")
        turn = self._turn(node.inputs["Vector"], stack)
        field = self.read_image(node.image, node.image_user)
        return Field(field.values, Mapping(((0.0, 0.0, turn), (0.0, 0.0, 0.0))))

    def _turn(self, socket, stack):
        output, _, inner = follow(socket, stack)
        if output is None:
            return 0.0
        node = output.node
        if node.type == "TEX_COORD" and output.name == "Generated":
            return 0.0
        if node.type != "MAPPING" or node.vector_type not in ("POINT", "VECTOR", "TEXTURE"):
            raise Untranslated(f"coordinates of the environment from {node.bl_label} ({output.name}) are not translated")
        rotation, scale = self._fixed(node, inner, "Rotation"), self._fixed(node, inner, "Scale")
        c, s = np.cos(rotation[2]), np.sin(rotation[2])
        angle = turn_about_up([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        moves = node.vector_type != "VECTOR" and np.abs(self._fixed(node, inner, "Location")).max() > 1e-6
        if moves or np.abs(rotation[:2]).max() > 1e-6 or np.abs(scale - 1).max() > 1e-6:
            raise Untranslated("a Mapping node of the environment does more than turn it about z")
        turn = self._turn(find(node, "Vector"), inner)
        # A rotation of the coordinates turns the picture the other way.
        return turn + (angle if node.vector_type == "TEXTURE" else -angle)
