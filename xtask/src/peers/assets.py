"""Writes the pictures, meshes, curves and volumes that the scenes use. All of them are computed here."""

import struct

import mitsuba as mi
import numpy as np


def write(folder):
    pictures(folder)
    meshes(folder)
    curves(folder)
    grid(folder)


def grid_of(rows, columns):
    """Returns the coordinates of texel centres, from 0 to 1."""
    y, x = np.mgrid[0:rows, 0:columns]
    return (x + 0.5) / columns, (y + 0.5) / rows


def png(path, values):
    """Writes values from 0 to 1 as bytes, without conversion."""
    bytes_ = np.round(255 * np.clip(values, 0, 1)).astype(np.uint8)
    mi.Bitmap(np.ascontiguousarray(bytes_)).write(str(path))


def exr(path, values):
    mi.Bitmap(np.ascontiguousarray(values.astype(np.float32))).write(str(path))


def stack(*channels):
    return np.stack(np.broadcast_arrays(*channels), -1)


def pictures(folder):
    u, v = grid_of(6, 8)
    # Every corner has another colour, so that turned and mirrored pictures differ.
    png(folder / "colors.png", stack(0.2 + 0.7 * u, 0.3 + 0.5 * v, 0.8 - 0.6 * u * v))
    u, v = grid_of(8, 8)
    # A narrow range, so that its mean is meaningful, and large texels.
    png(folder / "grey.png", (0.3 + 0.5 * ((np.floor(4 * u) + np.floor(3 * v)) % 2))[..., None])
    png(folder / "ramp.png", (0.1 + 0.8 * u)[..., None])
    u, v = grid_of(64, 64)
    wave = 0.5 + 0.5 * np.sin(4 * np.pi * u) * np.sin(4 * np.pi * v)
    png(folder / "bumps.png", wave[..., None])
    exr(folder / "bumps.exr", wave[..., None])
    tilt = 0.35 * np.sin(4 * np.pi * u), 0.25 * np.sin(6 * np.pi * v)
    normal = stack(*tilt, np.ones_like(u))
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    png(folder / "normals.png", 0.5 + 0.5 * normal)
    exr(folder / "normals.exr", 0.5 + 0.5 * normal)
    u, v = grid_of(8, 16)
    light = stack(0.2 + 0.5 * u, 0.3 + 0.4 * v, 0.9 - 0.5 * u)
    light[2, 3] += (6, 5, 3)
    light[5, 12] += (0, 2, 4)
    exr(folder / "sky16.exr", light)
    u, v = grid_of(32, 64)
    exr(folder / "sky64.exr", stack(0.3 + 0.3 * np.cos(2 * np.pi * u), 0.4 + 0 * u, 0.9 - 0.7 * v) + 8 * ((u > 0.2) & (u < 0.25) & (v > 0.2) & (v < 0.3))[..., None])
    u, v = grid_of(16, 16)
    exr(folder / "bright.exr", stack(4 * u + 0.5, 1 + 0 * u, 3 * v + 0.2))


def sphere_mesh(rows=12, columns=24):
    """Returns positions, normals, texture coordinates and faces of a unit sphere around z."""
    theta, phi = np.meshgrid(np.linspace(0, np.pi, rows + 1), np.linspace(0, 2 * np.pi, columns + 1), indexing="ij")
    p = stack(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)).reshape(-1, 3)
    uv = stack(phi / (2 * np.pi), theta / np.pi).reshape(-1, 2)
    faces = []
    for i in range(rows):
        for j in range(columns):
            a, b = i * (columns + 1) + j, (i + 1) * (columns + 1) + j
            faces += [(a, b, b + 1)] * (i < rows - 1) + [(a, b + 1, a + 1)] * (i > 0)
    return p, p, uv, faces


def ply(path, positions, faces, normals=None, uvs=None, colors=None):
    columns, names = [positions], "x y z".split()
    for extra, more in [(normals, "nx ny nz"), (uvs, "u v"), (colors, "r g b")]:
        if extra is not None:
            columns.append(extra)
            names += more.split()
    rows = np.hstack(columns).astype("<f4")
    head = "ply\nformat binary_little_endian 1.0\n" + f"element vertex {len(rows)}\n"
    head += "".join(f"property float {name}\n" for name in names)
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    with open(path, "wb") as file:
        file.write(head.encode() + rows.tobytes())
        for face in faces:
            file.write(struct.pack("<B3i", 3, *face))


def meshes(folder):
    p, n, uv, faces = sphere_mesh()
    ply(folder / "ball.ply", p, faces, n, uv)
    # Each pole is a single vertex, and no vertex is unused.
    used = sorted({i for face in faces for i in face})
    ply(folder / "bare-ball.ply", p[used], [[used.index(i) for i in face] for face in faces])
    ply(folder / "colored-ball.ply", p, faces, n, uv, 0.5 + 0.45 * p[:, [2, 0, 1]])
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [(a, b, c) for a, b, c, d in sides] + [(a, c, d) for a, b, c, d in sides]
    ply(folder / "block.ply", corners, triangles)
    lines = [f"v {words(a)}" for a in p] + [f"vt {a:.6f} {b:.6f}" for a, b in uv] + [f"vn {words(a)}" for a in n]
    lines += ["f " + " ".join(f"{i + 1}/{i + 1}/{i + 1}" for i in face) for face in faces]
    (folder / "ball.obj").write_text("\n".join(lines) + "\n")
    # A wall, wavy in depth, in an OBJ file without normals.
    u, v = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 9)))
    lines = [f"v {2 * a - 1:.6f} {2 * b - 1:.6f} {0.15 * np.sin(9 * a):.6f}" for a, b in zip(u, v)]
    lines += [f"vt {a:.6f} {b:.6f}" for a, b in zip(u, v)]
    for i in range(8):
        for j in range(8):
            a, b, c, d = (9 * i + j + k + 1 for k in (0, 1, 10, 9))
            lines += [f"f {a}/{a} {b}/{b} {c}/{c}", f"f {a}/{a} {c}/{c} {d}/{d}"]
    (folder / "wave.obj").write_text("\n".join(lines) + "\n")


def words(values):
    return " ".join(f"{v:.6f}" for v in values)


def curves(folder):
    lines = []
    for i in range(12):
        x = -1.1 + 0.2 * i
        for k in range(6):
            lines.append(f"{x + 0.08 * np.sin(1.5 * k + i):.5f} {0.3 * k - 0.2:.5f} {0.2 * np.cos(k + 2 * i):.5f} {0.07 - 0.008 * k:.5f}")
        lines.append("")
    (folder / "curves.txt").write_text("\n".join(lines))
    (folder / "stick.txt").write_text("-0.8 0.2 0 0.2\n0 1.1 0.1 0.2\n0.8 0.3 -0.2 0.2\n")


def grid(folder):
    z, y, x = np.mgrid[0:6, 0:5, 0:4]
    values = 0.3 + 0.7 * ((x + 2 * y + 3 * z) % 4) / 3
    mi.VolumeGrid(np.ascontiguousarray(values[..., None].astype(np.float32))).write(str(folder / "density.vol"))
