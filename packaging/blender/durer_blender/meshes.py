"""Meshes: evaluated meshes of Blender as PLY files, one for each material of a mesh."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Part:
    """The triangles of a mesh that have one material."""

    file: str
    slot: int


def read(collection, name, kind, width):
    """Returns a property of all elements of a collection as an array of rows."""
    values = np.empty(len(collection) * width, kind)
    collection.foreach_get(name, values)
    return values.reshape(len(collection), width) if width > 1 else values


def active_uv(mesh):
    """Returns the name of the UV map that is active in renders, or an empty text."""
    return next((layer.name for layer in mesh.uv_layers if layer.active_render), "")


def second_uv(mesh, active, wanted):
    """Returns the first of the wanted UV maps that the mesh has besides the active one."""
    return next((name for name in wanted if name != active and name in mesh.uv_layers), "")


def corner_columns(mesh, second, colors):
    """Returns the columns of a PLY file, as pairs of names and rows, for all corners of polygons.
    `colors` are those of the corners, or None."""
    corners = read(mesh.loops, "vertex_index", np.int32, 1)
    columns = [(("x", "y", "z"), read(mesh.vertices, "co", np.float32, 3)[corners])]
    if mesh.normals_domain != "FACE":
        normals = read(mesh.corner_normals, "vector", np.float32, 3)
        columns.append((("nx", "ny", "nz"), normals))
    active = active_uv(mesh)
    for names, layer in ((("u", "v"), active), (("second_u", "second_v"), second)):
        if layer:
            columns.append((names, read(mesh.uv_layers[layer].uv, "vector", np.float32, 2)))
    if colors is not None:
        names = ("linear_red", "linear_green", "linear_blue", "linear_alpha")
        columns.append((names, np.append(colors, np.ones_like(colors[:, :1]), 1)))
    return columns


def vertex_colors(mesh, name):
    """Returns the linear colours of an attribute for all corners, or None if the mesh has no such
    colours."""
    attributes = mesh.color_attributes
    index = attributes.render_color_index
    found = attributes.get(name) if name else attributes[index] if 0 <= index < len(attributes) else None
    if found is None:
        return None
    values = read(found.data, "color", np.float32, 4)[:, :3]
    return values if found.domain == "CORNER" else values[read(mesh.loops, "vertex_index", np.int32, 1)]


def join(columns):
    """Joins equal corners: returns the index of a corner for each vertex, and the vertex of each
    corner."""
    key = None
    for _, rows in columns:
        for column in np.ascontiguousarray(rows).T:
            _, index = np.unique(column, return_inverse=True)
            if key is None:
                key = index.astype(np.int64)
            else:
                _, key = np.unique(key * (int(index.max()) + 1) + index, return_inverse=True)
    _, first, vertex = np.unique(key, return_index=True, return_inverse=True)
    return first, vertex.reshape(-1)


def ply(columns, triangles, is_flat):
    """Returns a binary PLY file. `triangles` are rows of indices of the columns' rows."""
    names = [name for group, _ in columns for name in group]
    head = "ply\nformat binary_little_endian 1.0\n" + ("obj_info flat\n" if is_flat else "")
    head += f"element vertex {len(columns[0][1])}\n" + "".join(f"property float {name}\n" for name in names)
    head += f"element face {len(triangles)}\nproperty list uchar uint vertex_indices\nend_header\n"
    faces = np.zeros(len(triangles), [("count", "u1"), ("corners", "<u4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    rows = np.concatenate([rows for _, rows in columns], 1).astype("<f4")
    return head.encode() + rows.tobytes() + faces.tobytes()


def write(mesh, name, second, colors_of, files):
    """Adds the PLY files of a mesh to `files`, and returns its parts. `colors_of` returns the name
    of the vertex colours that a material slot uses, or None."""
    mesh.calc_loop_triangles()
    if not len(mesh.loop_triangles):
        return []
    triangles = read(mesh.loop_triangles, "loops", np.int32, 3)
    slots = read(mesh.loop_triangles, "material_index", np.int32, 1)
    parts = []
    for slot in np.unique(slots):
        wanted = colors_of(int(slot))
        columns = corner_columns(mesh, second, None if wanted is None else vertex_colors(mesh, wanted))
        chosen = triangles[slots == slot]
        used, corners = np.unique(chosen, return_inverse=True)
        columns = [(names, rows[used]) for names, rows in columns]
        if not all(np.isfinite(rows).all() for _, rows in columns):
            columns = [(names, np.nan_to_num(rows, posinf=0, neginf=0)) for names, rows in columns]
        first, vertex = join(columns)
        columns = [(names, rows[first]) for names, rows in columns]
        file = f"{name}-{slot}.ply"
        files[file] = ply(columns, vertex[corners.reshape(-1, 3)], mesh.normals_domain == "FACE")
        parts.append(Part(file, int(slot)))
    return parts
