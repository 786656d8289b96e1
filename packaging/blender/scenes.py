"""Ten scenes that are built in Blender, to compare the add-on with Cycles. Each function builds one
in an empty file, and its first line says what it covers."""

import math

import bmesh
import bpy
import mathutils
import numpy as np


def new_material(name, kind="ShaderNodeBsdfPrincipled", **values):
    """Returns a material of one shader, with the values of its inputs, and the shader."""
    material = bpy.data.materials.new(name)
    if hasattr(material, "use_nodes") and bpy.app.version < (5, 0):
        material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    shader, end = nodes.new(kind), nodes.new("ShaderNodeOutputMaterial")
    links.new(shader.outputs[0], end.inputs["Surface"])
    for name, value in values.items():
        target = shader.inputs[name.replace("_", " ")]
        target.default_value = (*value, 1) if isinstance(value, tuple) and len(target.default_value) == 4 else value
    return material, shader


def matte(name, color):
    return new_material(name, "ShaderNodeBsdfDiffuse", Color=color)[0]


def add(name, data, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1)):
    item = bpy.data.objects.new(name, data)
    item.location, item.rotation_euler, item.scale = location, rotation, scale
    bpy.context.scene.collection.objects.link(item)
    return item


def shape(name, make, material=None, smooth=False, **place):
    """Adds an object with the mesh that a function of bmesh makes."""
    mesh, work = bpy.data.meshes.new(name), bmesh.new()
    make(work)
    work.to_mesh(mesh)
    work.free()
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(mesh.polygons))
    if material is not None:
        mesh.materials.append(material)
    return add(name, mesh, **place)


def plane(material, size=10.0, **place):
    mesh = bpy.data.meshes.new("plane")
    half = size / 2
    mesh.from_pydata([(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32).ravel())
    mesh.materials.append(material)
    return add("plane", mesh, **place)


def sphere(material, radius=1.0, segments=64, **place):
    def make(work):
        work.loops.layers.uv.new("UVMap")
        bmesh.ops.create_uvsphere(work, u_segments=segments, v_segments=segments // 2, radius=radius, calc_uvs=True)

    return shape("sphere", make, material, smooth=True, **place)


def cube(material, size=1.0, **place):
    return shape("cube", lambda work: bmesh.ops.create_cube(work, size=size), material, **place)


def light(kind, location, rotation=(0, 0, 0), **values):
    data = bpy.data.lights.new(kind.lower(), kind)
    for name, value in values.items():
        setattr(data, name, value)
    return add(kind.lower(), data, location, rotation)


def camera(location, target=(0, 0, 0), **values):
    data = bpy.data.cameras.new("camera")
    for name, value in values.items():
        setattr(data, name, value)
    turn = (mathutils.Vector(target) - mathutils.Vector(location)).to_track_quat("-Z", "Y").to_euler()
    item = add("camera", data, location, turn)
    bpy.context.scene.camera = item
    return data


def picture(name, function, size=(64, 64), is_float=False, is_data=False):
    """Returns a generated image. `function` maps arrays of u and v to arrays of red, green, blue and
    alpha."""
    width, height = size
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float, is_data=is_data)
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    channels = np.broadcast_arrays(*(np.asarray(channel, np.float32) for channel in function(u, v)), u)[:4]
    image.pixels.foreach_set(np.stack(channels, -1).astype(np.float32).ravel())
    image.update()
    image.pack()
    return image


def image_node(material, image, **values):
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    for name, value in values.items():
        setattr(node, name, value)
    return node


def background(color, strength=1.0):
    """Gives the scene a world, and returns its background node."""
    world = bpy.data.worlds.new("world")
    if bpy.app.version < (5, 0):
        world.use_nodes = True
    bpy.context.scene.world = world
    node = next(node for node in world.node_tree.nodes if node.bl_idname == "ShaderNodeBackground")
    node.inputs["Color"].default_value, node.inputs["Strength"].default_value = (*color, 1), strength
    return node


def sky(rotation=0.0):
    """Gives the scene an environment texture: a gradient with a bright spot."""

    def colors(u, v):
        spot = np.exp(-(((u - 0.3) * 2) ** 2 + (v - 0.72) ** 2) / 0.002)
        return 0.2 + 0.3 * v + 30 * spot, 0.3 + 0.3 * v + 26 * spot, 0.4 + 0.6 * v + 20 * spot, 1 + 0 * u

    node = background((1, 1, 1), 0.8)
    tree = node.id_data
    texture, mapping, place = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexEnvironment", "Mapping", "TexCoord"))
    texture.image = picture("sky", colors, (256, 128), is_float=True)
    mapping.inputs["Rotation"].default_value = (0, 0, rotation)
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], node.inputs["Color"])


def modifiers():
    """Point lights with and without a radius; modifiers, a material for each face, and flat, smooth
    and bevelled surfaces."""
    plane(matte("floor", (0.7, 0.7, 0.65)))
    item = cube(matte("red", (0.8, 0.1, 0.1)), location=(-0.9, 0, 0.5), rotation=(0, 0, 0.4))
    for number, color in enumerate(((0.1, 0.7, 0.2), (0.1, 0.2, 0.8))):
        item.data.materials.append(matte(f"side{number}", color))
    item.data.polygons[4].material_index, item.data.polygons[5].material_index = 1, 2
    item.modifiers.new("bevel", "BEVEL").width = 0.1
    other = cube(matte("white", (0.8, 0.8, 0.8)), location=(0.7, 0.3, 0.6))
    other.modifiers.new("subdivision", "SUBSURF").render_levels = 3
    other.data.polygons.foreach_set("use_smooth", [True] * 6)
    hidden = cube(matte("hidden", (1, 0, 1)), location=(0, -1, 0.5))
    hidden.hide_render = True
    light("POINT", (1.5, -1.5, 2.5), energy=120, shadow_soft_size=0.4, use_soft_falloff=False, color=(1, 0.8, 0.6))
    light("POINT", (-2, -1, 2), energy=40, shadow_soft_size=0, color=(0.6, 0.8, 1))
    camera((2.2, -4, 2.6), (0, 0, 0.4))


def spot_and_sun():
    """A spotlight with a soft edge, and a sun with an angle."""
    plane(matte("floor", (0.7, 0.7, 0.7)))
    cube(matte("box", (0.7, 0.4, 0.2)), location=(0, 0, 0.5), rotation=(0, 0, 0.5))
    sphere(matte("ball", (0.2, 0.5, 0.7)), radius=0.5, location=(1.2, 0.5, 0.5))
    light("SPOT", (-1, -1, 4), (0.25, -0.25, 0), energy=400, shadow_soft_size=0, spot_size=0.7, spot_blend=0.4)
    light("SUN", (0, 0, 5), (0.6, 0.4, 0), energy=0.8, angle=0.1, color=(1, 0.9, 0.7))
    camera((3, -4, 3.5))


def room():
    """A closed room with area lights of all four shapes, and light between its walls."""
    white, red, green = matte("white", (0.75, 0.75, 0.75)), matte("red", (0.7, 0.1, 0.1)), matte("green", (0.1, 0.5, 0.1))
    half = math.pi / 2
    plane(white, 4)
    plane(white, 4, location=(0, 0, 4), rotation=(math.pi, 0, 0))
    plane(white, 4, location=(0, 2, 2), rotation=(half, 0, 0))
    plane(red, 4, location=(-2, 0, 2), rotation=(0, half, 0))
    plane(green, 4, location=(2, 0, 2), rotation=(0, -half, 0))
    cube(white, 1.2, location=(-0.6, 0.4, 0.6), rotation=(0, 0, 0.3))
    sphere(white, 0.6, location=(0.8, -0.3, 0.6))
    light("AREA", (0, 0, 3.9), energy=40, shape="SQUARE", size=1)
    light("AREA", (-1.3, 1.9, 3), (-half, 0, 0), energy=8, shape="DISK", size=0.8, color=(1, 0.7, 0.4))
    light("AREA", (1.2, 1.9, 2), (-half, 0, 0), energy=8, shape="RECTANGLE", size=1, size_y=0.3, color=(0.4, 0.7, 1))
    item = light("AREA", (0, -1.5, 3.5), (0.6, 0, 0), energy=15, shape="ELLIPSE", size=1, size_y=0.5)
    item.scale = (1.5, 0.7, 1)
    camera((0, -5.8, 2), (0, 0, 2), lens=30)


def textures():
    """Image textures: a mapping, an image that nodes change, vertex colours, and a second UV map."""
    image = picture("tiles", lambda u, v: (0.2 + 0.6 * u, 0.3 + 0.3 * np.cos(12 * v), 0.8 - 0.6 * v, 1 + 0 * u))
    floor, shader = new_material("floor", "ShaderNodeBsdfDiffuse")
    nodes, links = floor.node_tree.nodes, floor.node_tree.links
    mapping, place, texture = nodes.new("ShaderNodeMapping"), nodes.new("ShaderNodeTexCoord"), image_node(floor, image)
    mapping.inputs["Location"].default_value, mapping.inputs["Rotation"].default_value = (0.1, 0.3, 0), (0, 0, 0.4)
    mapping.inputs["Scale"].default_value = (4, 3, 1)
    links.new(place.outputs["UV"], mapping.inputs["Vector"])
    links.new(mapping.outputs[0], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], shader.inputs["Color"])
    plane(floor)
    changed, shader = new_material("changed", Roughness=0.4)
    nodes, links = changed.node_tree.nodes, changed.node_tree.links
    texture, hue, invert = image_node(changed, image), nodes.new("ShaderNodeHueSaturation"), nodes.new("ShaderNodeInvert")
    hue.inputs["Hue"].default_value, hue.inputs["Saturation"].default_value = 0.7, 1.2
    invert.inputs[0].default_value = 0.2
    links.new(texture.outputs["Color"], hue.inputs["Color"])
    links.new(hue.outputs[0], invert.inputs["Color"])
    links.new(invert.outputs[0], shader.inputs["Base Color"])
    sphere(changed, 0.7, location=(-1.1, 0, 0.7))
    colored, shader = new_material("colored", "ShaderNodeBsdfDiffuse")
    node = colored.node_tree.nodes.new("ShaderNodeVertexColor")
    colored.node_tree.links.new(node.outputs["Color"], shader.inputs["Color"])
    other = sphere(colored, 0.7, location=(0.9, 0.4, 0.7))
    colors = other.data.color_attributes.new("Color", "FLOAT_COLOR", "POINT")
    places = np.empty(3 * len(other.data.vertices), np.float32)
    other.data.vertices.foreach_get("co", places)
    rows = np.append(places.reshape(-1, 3) / 1.4 + 0.5, np.ones((len(places) // 3, 1)), 1).astype(np.float32)
    colors.data.foreach_set("color", rows.ravel())
    node.layer_name = "Color"
    stripes = picture("stripes", lambda u, v: (*(((8 * u) % 1 < 0.5) * 0.8 + 0.1,) * 3, 1 + 0 * u))
    board, shader = new_material("board", "ShaderNodeBsdfDiffuse")
    texture, uv = image_node(board, stripes, interpolation="Closest"), board.node_tree.nodes.new("ShaderNodeUVMap")
    uv.uv_map = "other"
    board.node_tree.links.new(uv.outputs[0], texture.inputs["Vector"])
    board.node_tree.links.new(texture.outputs["Color"], shader.inputs["Color"])
    wall = plane(board, 4, location=(0, 2.5, 1.5), rotation=(math.pi / 2, 0, 0))
    layer = wall.data.uv_layers.new(name="other")
    layer.uv.foreach_set("vector", np.array([(0, 0), (0, 2), (2, 2), (2, 0)], np.float32).ravel())
    light("SUN", (0, 0, 5), (0.5, 0.3, 0), energy=2.5, angle=0)
    background((0.3, 0.35, 0.4))
    camera((0.5, -4.5, 2.6), (0, 0, 0.8))


def glass():
    """Clear, coloured and rough glass under an area light, with bright surroundings."""
    image = picture("checks", lambda u, v: (*((np.floor(8 * u) + np.floor(8 * v)) % 2 * 0.6 + 0.2,) * 3, 1 + 0 * u))
    floor, shader = new_material("floor", "ShaderNodeBsdfDiffuse")
    floor.node_tree.links.new(image_node(floor, image, interpolation="Closest").outputs["Color"], shader.inputs["Color"])
    plane(floor, 8)
    sphere(new_material("clear", "ShaderNodeBsdfGlass", IOR=1.5, Roughness=0.0)[0], 0.7, location=(-1.5, 0, 0.7))
    tinted = new_material("tinted", Base_Color=(0.5, 0.8, 0.6), Roughness=0.0, IOR=1.45, Transmission_Weight=1.0)[0]
    sphere(tinted, 0.7, location=(0, 0.3, 0.7))
    sphere(new_material("rough", "ShaderNodeBsdfGlass", IOR=1.5, Roughness=0.3)[0], 0.7, location=(1.5, 0, 0.7))
    light("AREA", (0, 0, 5), energy=300, shape="SQUARE", size=4)
    background((0.4, 0.5, 0.6))
    camera((0, -5, 2.5), (0, 0, 0.6))


def metals():
    """Metals of five roughnesses, anisotropic and coated ones, under an environment texture."""
    sky(0.6)
    plane(matte("floor", (0.4, 0.4, 0.4)), 12)
    for number in range(5):
        metal = new_material(f"gold{number}", Base_Color=(0.9, 0.65, 0.3), Metallic=1.0, Roughness=0.05 + 0.2 * number)[0]
        sphere(metal, 0.45, location=(number - 2, 0, 0.45))
    brushed = dict(Base_Color=(0.8, 0.8, 0.85), Metallic=1.0, Roughness=0.35, Anisotropic=0.8)
    sphere(new_material("brushed", **brushed)[0], 0.45, location=(-1, -1.1, 0.45))
    paint = dict(Base_Color=(0.6, 0.05, 0.05), Roughness=0.6, Coat_Weight=1.0, Coat_Roughness=0.05)
    sphere(new_material("paint", **paint)[0], 0.45, location=(0, -1.1, 0.45))
    mirror = new_material("glossy", "ShaderNodeBsdfAnisotropic", Color=(0.9, 0.9, 0.9), Roughness=0.2)[0]
    sphere(mirror, 0.45, location=(1, -1.1, 0.45))
    camera((0, -5.5, 2.4), (0, -0.3, 0.4))


def instances():
    """Instances of collections, particles and geometry nodes, an array, mirrored and scaled."""
    plane(matte("floor", (0.6, 0.6, 0.6)), 12)
    group = bpy.data.collections.new("pair")
    for place, color in (((0, 0, 0.2), (0.8, 0.3, 0.1)), ((0, 0, 0.6), (0.2, 0.4, 0.8))):
        item = cube(matte("part", color), 0.4, location=place, rotation=(0, 0, place[2]))
        bpy.context.scene.collection.objects.unlink(item)
        group.objects.link(item)
    for number in range(4):
        holder = add("pair", None, (number - 1.5, 1.2, 0), (0, 0, number), (1, 1 if number % 2 else -1, 1 + 0.3 * number))
        holder.instance_type, holder.instance_collection = "COLLECTION", group
    row = cube(matte("row", (0.3, 0.7, 0.3)), 0.3, location=(-1.8, -1.2, 0.15))
    array = row.modifiers.new("array", "ARRAY")
    array.count, array.relative_offset_displace = 6, (1.6, 0, 0)
    seed = sphere(matte("seed", (0.8, 0.7, 0.2)), 1.0, 24, location=(20, 0, 0))
    ground = plane(matte("bed", (0.3, 0.2, 0.1)), 2, location=(-0.9, 0, 0.02))
    settings = ground.modifiers.new("grass", "PARTICLE_SYSTEM").particle_system.settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 60, 1, 1, 100
    settings.type, settings.render_type, settings.instance_object = "HAIR", "OBJECT", seed
    settings.particle_size, settings.hair_length = 0.08, 1.0
    points = shape("points", lambda work: bmesh.ops.create_grid(work, x_segments=4, y_segments=4, size=0.6), location=(1.1, 0, 0.15))
    tree = bpy.data.node_groups.new("scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    start, end, put, cone, paint = (
        tree.nodes.new(kind)
        for kind in ("NodeGroupInput", "NodeGroupOutput", "GeometryNodeInstanceOnPoints", "GeometryNodeMeshCone", "GeometryNodeSetMaterial")
    )
    cone.inputs["Radius Bottom"].default_value, cone.inputs["Depth"].default_value = 0.12, 0.4
    paint.inputs["Material"].default_value = matte("cone", (0.7, 0.2, 0.6))
    tree.links.new(cone.outputs["Mesh"], paint.inputs["Geometry"])
    tree.links.new(paint.outputs["Geometry"], put.inputs["Instance"])
    tree.links.new(start.outputs[0], put.inputs["Points"])
    tree.links.new(put.outputs[0], end.inputs[0])
    points.modifiers.new("scatter", "NODES").node_group = tree
    light("SUN", (0, 0, 5), (0.5, 0.4, 0), energy=2.5, angle=0.05)
    background((0.4, 0.45, 0.5))
    camera((0.5, -4.8, 3.4), (0, 0.1, 0.2))


def lens():
    """Depth of field with a bladed aperture, a shifted and vertically fitted sensor, and plastics
    under an environment texture."""
    sky(2.5)
    plane(matte("floor", (0.5, 0.5, 0.5)), 20)
    for number in range(5):
        color = ((0.8, 0.1, 0.1), (0.8, 0.6, 0.1), (0.1, 0.6, 0.2), (0.1, 0.3, 0.8), (0.5, 0.1, 0.6))[number]
        plastic = new_material(f"plastic{number}", Base_Color=color, Roughness=0.1 + 0.2 * number)[0]
        sphere(plastic, 0.5, location=(number - 2, 1.5 * number - 2, 0.5))
    data = camera((0.3, -6, 1.5), (0, 0, 0.3), lens=40, sensor_fit="VERTICAL", sensor_height=28, shift_x=0.05, shift_y=0.08)
    data.dof.use_dof, data.dof.focus_distance, data.dof.aperture_fstop = True, 5.5, 0.12
    data.dof.aperture_blades, data.dof.aperture_rotation = 6, 0.3


def relief():
    """An orthographic camera, a normal map of half strength, a bump map, and light from a grazing
    sun."""

    def normals(u, v):
        x, y = 0.5 * np.cos(40 * u), 0.5 * np.cos(30 * v)
        z = np.sqrt(1 - x * x - y * y)
        return 0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.5 + 0.5 * z, 1 + 0 * u

    mapped, shader = new_material("mapped", Base_Color=(0.6, 0.5, 0.4), Roughness=0.5)
    node = mapped.node_tree.nodes.new("ShaderNodeNormalMap")
    node.inputs["Strength"].default_value = 0.5
    texture = image_node(mapped, picture("normals", normals, (256, 256), is_data=True))
    mapped.node_tree.links.new(texture.outputs["Color"], node.inputs["Color"])
    mapped.node_tree.links.new(node.outputs[0], shader.inputs["Normal"])
    plane(mapped, 4, location=(-1, 0, 0))
    bumped, shader = new_material("bumped", "ShaderNodeBsdfDiffuse", Color=(0.5, 0.6, 0.7))
    node = bumped.node_tree.nodes.new("ShaderNodeBump")
    node.inputs["Distance"].default_value = 0.1
    heights = picture("heights", lambda u, v: (*(0.5 + 0.5 * np.sin(25 * u) * np.sin(25 * v),) * 3, 1 + 0 * u), (256, 256), is_data=True)
    bumped.node_tree.links.new(image_node(bumped, heights).outputs["Color"], node.inputs["Height"])
    bumped.node_tree.links.new(node.outputs[0], shader.inputs["Normal"])
    plane(bumped, 2, location=(2, 0, 0))
    light("SUN", (0, 0, 5), (0.7, 0.5, 0), energy=3, angle=0.02)
    background((0.1, 0.1, 0.12))
    camera((0.3, 0, 5), (0.3, 0, 0), type="ORTHO", ortho_scale=4.6, shift_x=0.02)


def alpha():
    """A transparent film, leaves cut out by alpha, a mixture with a Transparent shader, mixed
    shaders, and surfaces that emit light."""
    bpy.context.scene.render.film_transparent = True

    def leaf(u, v):
        inside = (np.abs(u - 0.5) * 2) ** 2 + (np.abs(v - 0.5) * 2) ** 2 < 0.8
        return 0.2 + 0 * u, 0.5 + 0.3 * v, 0.1 + 0 * u, inside * 1.0

    image = picture("leaf", leaf, (256, 256))
    cut, shader = new_material("cut", Roughness=0.6)
    texture = image_node(cut, image)
    cut.node_tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    cut.node_tree.links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
    plane(cut, 1.2, location=(-1, 0, 1), rotation=(1.2, 0, 0.2))
    veil = bpy.data.materials.new("veil")
    if bpy.app.version < (5, 0):
        veil.use_nodes = True
    nodes, links = veil.node_tree.nodes, veil.node_tree.links
    nodes.clear()
    kinds = ("OutputMaterial", "MixShader", "BsdfTransparent", "BsdfDiffuse")
    end, mix, clear, body = (nodes.new(f"ShaderNode{kind}") for kind in kinds)
    mix.inputs[0].default_value, body.inputs["Color"].default_value = 0.6, (0.8, 0.2, 0.2, 1)
    links.new(clear.outputs[0], mix.inputs[1])
    links.new(body.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], end.inputs["Surface"])
    plane(veil, 1.2, location=(0.3, 0.3, 0.9), rotation=(1.3, 0, -0.2))
    blend = bpy.data.materials.new("blend")
    if bpy.app.version < (5, 0):
        blend.use_nodes = True
    nodes, links = blend.node_tree.nodes, blend.node_tree.links
    nodes.clear()
    kinds = ("OutputMaterial", "MixShader", "BsdfAnisotropic", "BsdfDiffuse")
    end, mix, gloss, body = (nodes.new(f"ShaderNode{kind}") for kind in kinds)
    mix.inputs[0].default_value, body.inputs["Color"].default_value = 0.5, (0.2, 0.3, 0.8, 1)
    gloss.inputs["Color"].default_value, gloss.inputs["Roughness"].default_value = (1, 1, 1, 1), 0.3
    links.new(gloss.outputs[0], mix.inputs[1])
    links.new(body.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], end.inputs["Surface"])
    sphere(blend, 0.5, location=(1.2, -0.4, 0.5))
    plane(matte("floor", (0.6, 0.6, 0.6)), 5)
    glow = new_material("glow", "ShaderNodeEmission", Color=(1, 0.8, 0.5), Strength=6.0)[0]
    plane(glow, 0.8, location=(-0.4, -1.2, 1.6), rotation=(0.6, 0.4, 0))
    sphere(new_material("bulb", Base_Color=(0, 0, 0), Emission_Color=(0.5, 0.7, 1), Emission_Strength=5.0)[0], 0.2, location=(0.4, -1, 0.2))
    light("SUN", (0, 0, 5), (0.5, -0.4, 0), energy=1.5, angle=0.05)
    background((0.3, 0.35, 0.4))
    camera((0.3, -4.6, 2.2), (0, 0, 0.7))


#: Scenes with the largest difference of the means from 1, and the largest mean FLIP, with which a
#: comparison passes.
SCENES = {
    "modifiers": (modifiers, 0.01, 0.03),
    "spot and sun": (spot_and_sun, 0.01, 0.03),
    "room": (room, 0.01, 0.04),
    "textures": (textures, 0.01, 0.03),
    "glass": (glass, 0.01, 0.04),
    "metals": (metals, 0.01, 0.03),
    "instances": (instances, 0.01, 0.03),
    "lens": (lens, 0.01, 0.03),
    "relief": (relief, 0.01, 0.03),
    "alpha": (alpha, 0.01, 0.03),
}
