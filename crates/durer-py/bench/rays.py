"""Measures rays per second from Python, for Dürer and for those of embreex, trimesh, Open3D and
Mitsuba that are installed. All trace the same rays, in one run.

    python crates/durer-py/bench/rays.py [mesh.ply] [millions of rays]

If cargo is available, the same rays are also traced by the kernel from Rust, without Python.
"""

import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import durer


def ball(cuts: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns a bumpy sphere, the default mesh."""
    t, p = np.meshgrid(np.linspace(0.01, np.pi - 0.01, cuts), np.linspace(0, 2 * np.pi, 2 * cuts), indexing="ij")
    r = 1 + 0.05 * np.sin(20 * t) * np.sin(20 * p)
    v = np.stack([r * np.sin(t) * np.cos(p), r * np.sin(t) * np.sin(p), r * np.cos(t)], -1).reshape(-1, 3)
    i = np.arange((cuts - 1) * 2 * cuts).reshape(cuts - 1, 2 * cuts)[:, :-1].reshape(-1)
    n = 2 * cuts
    return v.astype("f4"), np.concatenate([np.stack([i, i + n, i + n + 1], 1), np.stack([i, i + n + 1, i + 1], 1)]).astype("i4")


def ray_sets(count: int) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    side, rng = int(count**0.5), np.random.default_rng(1)
    # Order the pixels in tiles of 8 x 8, as renderers do.
    tiles = np.arange(side // 8 * 8).reshape(-1, 8)
    y, x = (a.reshape(-1) for a in np.meshgrid(np.arange(side // 8 * 8), np.arange(side // 8 * 8), indexing="ij"))
    order = np.lexsort((x % 8, y % 8, x // 8, y // 8))
    d = np.stack([x[order] / len(tiles) / 8 - 0.5, y[order] / len(tiles) / 8 - 0.5, -1.5 * np.ones(len(x))], -1)
    d = d / np.linalg.norm(d, axis=1, keepdims=True)
    eye = np.broadcast_to(np.float32([0, 0, 3]), d.shape)
    o = rng.normal(size=(count, 3))
    o *= 2 / np.linalg.norm(o, axis=1, keepdims=True)
    return {
        "camera": (np.ascontiguousarray(eye, "f4"), d.astype("f4")),
        "random": (o.astype("f4"), (rng.uniform(-0.9, 0.9, o.shape) - o).astype("f4")),
    }


def libraries(v: np.ndarray, f: np.ndarray) -> dict:
    found = {}
    mesh = durer.Mesh(v, f, "best")
    found["durer, 1 thread"] = lambda o, d: mesh.closest(o, d, threads=1, progress=False).t
    found["durer, 2 threads"] = lambda o, d: mesh.closest(o, d, threads=2, progress=False).t
    try:
        from embreex import rtcore_scene
        from embreex.mesh_construction import TriangleMesh

        scene = rtcore_scene.EmbreeScene()
        TriangleMesh(scene, v, f)
        found["embreex, 1 thread"] = lambda o, d: scene.run(o, d, query="DISTANCE")
    except ImportError:
        print("embreex is not installed")
    try:
        import trimesh

        theirs = trimesh.Trimesh(v, f, process=False)
        found["trimesh.ray, 1 thread"] = lambda o, d: theirs.ray.intersects_first(o, d)
    except ImportError:
        print("trimesh is not installed")
    try:
        import open3d

        rays = open3d.t.geometry.RaycastingScene()
        rays.add_triangles(open3d.core.Tensor(v), open3d.core.Tensor(f.astype("u4")))
        for threads in (1, 2):
            found[f"Open3D, {threads} threads"] = lambda o, d, n=threads: rays.cast_rays(
                open3d.core.Tensor(np.concatenate([o, d], 1)), nthreads=n
            )["t_hit"].numpy()
    except ImportError:
        print("Open3D is not installed")
    try:
        import mitsuba

        # The compiled variant uses all threads, and takes rays as columns.
        mitsuba.set_variant("llvm_ad_rgb")
        shape = mitsuba.Mesh("mesh", len(v), len(f))
        parameters = mitsuba.traverse(shape)
        parameters["vertex_positions"], parameters["faces"] = v.ravel(), f.ravel().astype("u4")
        parameters.update()
        world = mitsuba.load_dict({"type": "scene", "shape": shape})
        found["Mitsuba, all threads"] = lambda o, d: np.asarray(
            world.ray_intersect_preliminary(mitsuba.Ray3f(mitsuba.Point3f(o.T), mitsuba.Vector3f(d.T))).t
        )
    except ImportError:
        print("Mitsuba is not installed")
    return found


def rust(v: np.ndarray, f: np.ndarray, o: np.ndarray, d: np.ndarray, threads: int) -> float:
    """Returns millions of rays per second through the kernel's batches, called from Rust."""
    with tempfile.TemporaryDirectory() as folder:
        arrays = {"vertices.f32": v.astype("<f4"), "faces.u32": f.astype("<u4"), "origins.f32": o, "directions.f32": d}
        for name, array in arrays.items():
            (Path(folder) / name).write_bytes(np.ascontiguousarray(array).tobytes())
        manifest = Path(__file__).parents[3] / "bench/Cargo.toml"
        words = ["cargo", "run", "--release", "--quiet", "--manifest-path", str(manifest), "--"]
        done = subprocess.run([*words, "--arrays", folder, "--threads", str(threads)], capture_output=True, text=True, check=True)
        return float(done.stdout)


def rays_per_second(ask, o: np.ndarray, d: np.ndarray) -> float:
    start = time.perf_counter()
    ask(o, d)
    return time.perf_counter() - start


def main() -> None:
    count = int(1e6 * float(sys.argv[2] if len(sys.argv) > 2 else 1))
    if len(sys.argv) > 1:
        import trimesh

        loaded = trimesh.load(sys.argv[1], force="mesh", process=False)
        v, f = np.array(loaded.vertices, "f4"), np.array(loaded.faces, "i4")
        v = (v - (v.max(0) + v.min(0)) / 2) / (np.ptp(v, axis=0).max() / 2)
    else:
        v, f = ball(200)
    print(f"{len(f)} triangles, {count} rays; millions of rays a second, medians of 5 rounds in turn")
    everyone = libraries(v, f)
    for kind, (o, d) in ray_sets(count).items():
        times: dict[str, list[float]] = {name: [] for name in everyone}
        for _ in range(5):
            for name, ask in everyone.items():
                times[name].append(rays_per_second(ask, o, d))
        ours = np.median(times["durer, 1 thread"])
        for name, taken in times.items():
            print(f"{kind:8} {name:22} {len(o) / np.median(taken) / 1e6:8.2f}   ours, 1 thread: {np.median(taken) / ours:.2f} times")
        for threads in (1, 2) if shutil.which("cargo") else ():
            name = f"durer, {threads} thread{'s' * (threads > 1)}"
            rates, python = [], []
            # Measure as for the kernel: nine rounds in a row, not interleaved with the other
            # libraries.
            for _ in range(3):
                rates.append(rust(v, f, o, d, threads))
                python.append(len(o) / np.median([rays_per_second(everyone[name], o, d) for _ in range(9)]) / 1e6)
            rate, own = np.median(rates), np.median(python)
            print(f"{kind:8} from Rust, {threads} threads    {rate:8.2f}   from Python, likewise: {own:.2f}, {own / rate:.2f} of it")


if __name__ == "__main__":
    main()
