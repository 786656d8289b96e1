"""Compares how many rays each installed library loses at edges and vertices, with the same rays.

    python crates/durer-py/bench/edges.py [thousands of rays]

Each mesh is closed and convex, and all rays start inside it. A ray that hits nothing is lost,
and a ray that crosses more than one triangle is counted twice. Rays are aimed at points on edges
and at vertices.
"""

import sys
from collections.abc import Callable

import numpy as np

import durer

Rays = Callable[[np.ndarray, np.ndarray], np.ndarray]


def ball(cuts: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Returns a sphere with vertices at its poles, rotated so that nothing is axis-aligned."""
    t, p = np.meshgrid(np.linspace(0, np.pi, cuts + 1)[1:-1], np.arange(2 * cuts) * np.pi / cuts, indexing="ij")
    ring = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], -1).reshape(-1, 3)
    v = np.concatenate([ring, [[0, 0, 1], [0, 0, -1]]])
    n, i = 2 * cuts, np.arange(2 * cuts)
    j = (i + 1) % n
    faces = [np.stack([np.full(n, len(ring)), i, j], 1), np.stack([np.full(n, len(ring) + 1), j + (cuts - 2) * n, i + (cuts - 2) * n], 1)]
    for row in range(cuts - 2):
        a, b = row * n, (row + 1) * n
        faces += [np.stack([a + i, b + i, b + j], 1), np.stack([a + i, b + j, a + j], 1)]
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return (v @ q).astype("f4"), np.concatenate(faces).astype("i4")


def box(cuts: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns a cube of right triangles with integer vertices."""
    g = np.arange(cuts + 1)
    u, w = (a.reshape(-1) for a in np.meshgrid(g, g, indexing="ij"))
    i = (np.arange(cuts)[:, None] * (cuts + 1) + np.arange(cuts)).reshape(-1)
    cells = np.concatenate([np.stack([i, i + cuts + 1, i + cuts + 2], 1), np.stack([i, i + cuts + 2, i + 1], 1)])
    v, f = [], []
    for axis in range(3):
        for side in (0, cuts):
            f.append(cells + len(v) * len(u))
            v.append(np.roll(np.stack([np.full(len(u), side), u, w], 1), axis, 1))
    return np.concatenate(v).astype("f4"), np.concatenate(f).astype("i4")


def rays(v: np.ndarray, f: np.ndarray, count: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Returns float32 rays from points near the centre. One in eight is aimed at a vertex, all
    others at points on edges."""
    a, b = v[f[rng.integers(len(f), size=count)][:, :2].T]
    share = rng.uniform(size=(count, 1)).astype("f4")
    share[: count // 8] = 0
    middle, size = (v.max(0) + v.min(0)) / 2, np.ptp(v, axis=0).min()
    o = (middle + 0.2 * size * rng.uniform(-1, 1, (count, 3))).astype("f4")
    # Some start at round coordinates, as in hand-written tests.
    o[::2] = np.round(o[::2] * 4) / 4
    return o, (a + share * (b - a)) - o


def counters(v: np.ndarray, f: np.ndarray) -> dict[str, Rays]:
    """Returns, for each library that can count crossings, a function that returns the number of
    triangles that each ray crosses."""
    mesh = durer.Mesh(v, f)
    found: dict[str, Rays] = {"durer": lambda o, d: mesh.count(o, d, progress=False)}
    try:
        import trimesh
        from trimesh.ray.ray_triangle import RayMeshIntersector

        own = RayMeshIntersector(trimesh.Trimesh(v, f, process=False))
        found["trimesh, its own"] = lambda o, d: np.bincount(
            own.intersects_id(o, d, multiple_hits=True)[1], minlength=len(o)
        )
    except ImportError:
        pass
    try:
        import open3d

        cast = open3d.t.geometry.RaycastingScene()
        cast.add_triangles(open3d.core.Tensor(v), open3d.core.Tensor(f.astype("u4")))
        found["Open3D"] = lambda o, d: cast.count_intersections(
            open3d.core.Tensor(np.concatenate([o, d], 1))
        ).numpy()
    except ImportError:
        pass
    return found


def libraries(v: np.ndarray, f: np.ndarray) -> dict[str, Rays]:
    """Returns, for each installed library, a function that returns which rays hit something."""
    mesh = durer.Mesh(v, f)
    found: dict[str, Rays] = {"durer": lambda o, d: mesh.closest(o, d, progress=False).hit}
    try:
        from embreex import rtcore_scene
        from embreex.mesh_construction import TriangleMesh

        scene = rtcore_scene.EmbreeScene()
        TriangleMesh(scene, v, f)
        found["embreex"] = lambda o, d: np.asarray(scene.run(o, d)) >= 0
    except ImportError:
        print("embreex is not installed")
    try:
        import trimesh
        from trimesh.ray.ray_triangle import RayMeshIntersector

        own = RayMeshIntersector(trimesh.Trimesh(v, f, process=False))
        found["trimesh, its own"] = lambda o, d: np.asarray(own.intersects_first(o, d)) >= 0
    except ImportError:
        print("trimesh is not installed")
    try:
        import open3d

        cast = open3d.t.geometry.RaycastingScene()
        cast.add_triangles(open3d.core.Tensor(v), open3d.core.Tensor(f.astype("u4")))
        found["Open3D"] = lambda o, d: np.isfinite(
            cast.cast_rays(open3d.core.Tensor(np.concatenate([o, d], 1)))["t_hit"].numpy()
        )
    except ImportError:
        print("Open3D is not installed")
    try:
        import mitsuba

        mitsuba.set_variant("llvm_ad_rgb" if "llvm_ad_rgb" in mitsuba.variants() else "scalar_rgb")
        shape = mitsuba.Mesh("closed", len(v), len(f))
        parameters = mitsuba.traverse(shape)
        parameters["vertex_positions"], parameters["faces"] = v.ravel(), f.ravel().astype("u4")
        parameters.update()
        world = mitsuba.load_dict({"type": "scene", "shape": shape})

        def hit(o: np.ndarray, d: np.ndarray) -> np.ndarray:
            d = d / np.linalg.norm(d, axis=1, keepdims=True)
            return np.asarray(world.ray_test(mitsuba.Ray3f(mitsuba.Point3f(o.T), mitsuba.Vector3f(d.T)))).astype(bool)

        found["Mitsuba"] = hit
    except ImportError:
        print("Mitsuba is not installed")
    return found


def main() -> None:
    count = int(1000 * float(sys.argv[1] if len(sys.argv) > 1 else 1000))
    rng = np.random.default_rng(7)
    for name, (v, f) in {"ball": ball(40, rng), "box": box(16)}.items():
        o, d = rays(v, f, count, rng)
        print(f"{name} of {len(f)} triangles: of {count} rays to its edges and vertices, so many are lost or counted twice")
        counts = counters(v, f)
        for rival, hits in libraries(v, f).items():
            # trimesh's own ray caster is slow.
            some = slice(0, 20_000 if rival.startswith("trimesh") else count)
            lost = int((~np.asarray(hits(o[some], d[some]))).sum())
            twice = "?" if rival not in counts else str(int((counts[rival](o[some], d[some]) > 1).sum()))
            print(f"    {rival:18} {lost:8} of {len(o[some])}, counted twice: {twice}")


if __name__ == "__main__":
    main()
