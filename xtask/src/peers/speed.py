"""Compares the time to equal noise of Dürer and Mitsuba 3 (`llvm_ad_rgb`) on equal scenes, with the
best of Mitsuba's settings for each scene.

    python speed.py DURER MESHES [--side 256] [--samples 64] [--runs 5] [--threads 2] [--only
    TEXT]

Both render each scene in turn, with the same camera, filter, depth and number of samples, and
different seeds. `orthogonal` needs the square of a prime; Dürer then takes the next power of two,
which its own sampler prefers.
Mitsuba renders it with each of SETTINGS; the table shows the one with the shortest time to equal
error. The mean squared error of a program is half the mean squared difference over pairs
of its n pictures. This needs no reference picture, which could favour one program. The error falls
as one over the time, so the time to equal error is time times error. Time is the CPU time of all
threads: for Dürer minus that of a picture with one sample, which covers reading and building; for
Mitsuba after a first picture, which compiles. Figures use the minimum time of the runs.

The row below each scene is Dürer with `--adaptive`: as many samples on average, but more where the
picture is noisier. Mitsuba has no such mode, so the row shows the benefit of the mode and is not a
comparison of equal work; its column of means shows any bias.
"""

import argparse
import glob
import itertools
import os
import pathlib
import resource
import subprocess
import tempfile
import time

# Dr.Jit needs LLVM. The LLVM of Rust's compiler may support newer processors than that of the
# system.
if "DRJIT_LIBLLVM_PATH" not in os.environ:
    home = subprocess.run(["rustc", "--print", "sysroot"], capture_output=True, text=True).stdout.strip()
    os.environ.update({"DRJIT_LIBLLVM_PATH": found for found in glob.glob(f"{home}/lib/libLLVM.so*")[:1]})

import drjit as dr
import mitsuba as mi
import numpy as np
from own import Scene, lamp, matte, rgb
from picture import read_pfm


def read_ply(path):
    """Reads a mesh and returns the vertex positions of each triangle."""
    with open(path, "rb") as file:
        head = b""
        while not head.endswith(b"end_header\n"):
            head += file.readline()
        vertices, faces = (int(head.split(what)[1].split()[0]) for what in (b"vertex ", b"face "))
        corners = np.frombuffer(file.read(12 * vertices), "<f4").reshape(-1, 3)
        return corners[np.frombuffer(file.read(13 * faces), dtype=[("n", "u1"), ("i", "<i4", 3)])["i"]]


def write_ply(path, corners):
    """Writes a mesh without shared vertices, so that both programs shade it flat."""
    faces = np.arange(3 * len(corners), dtype="<i4").reshape(-1, 3)
    rows = np.zeros(len(corners), dtype=[("n", "u1"), ("i", "<i4", 3)])
    rows["n"], rows["i"] = 3, faces
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {faces.size}\nproperty float x\nproperty float y\n"
                   f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        file.write(corners.reshape(-1, 3).astype("<f4").tobytes() + rows.tobytes())


def write_pfm(path, pixels):
    with open(path, "wb") as file:
        file.write(f"PF\n{pixels.shape[1]} {pixels.shape[0]}\n-1\n".encode() + pixels[::-1].astype("<f4").tobytes())


def mesh(scene, path, surface, emitted=None):
    material, bsdf = surface if emitted is None else (lamp(emitted), matte((0, 0, 0))[1])
    theirs = {"type": "ply", "filename": str(path), "face_normals": True, "bsdf": bsdf if emitted else {"type": "twosided", "b": bsdf}}
    if emitted is not None:
        theirs["emitter"] = {"type": "area", "radiance": rgb(emitted)}
    scene.put(material, f"TriangleMesh {{ obj_file {path.name} }}", theirs)


def scenes(meshes, folder):
    cornell = Scene("Cornell box", 8).box()
    cornell.sphere((-0.4, -0.55, 0.2), 0.45, matte((0.5, 0.5, 0.5)))
    cornell.sphere((0.45, -0.6, -0.3), 0.4, matte((0.8, 0.6, 0.2)))
    yield cornell

    # A dim sky with a bright patch; its centre is towards -z in Dürer, and towards +z in Mitsuba.
    sky = np.full((128, 256, 3), (0.3, 0.4, 0.6))
    sky[20:30, 40:56] = (60, 50, 40)
    write_pfm(folder / "sky.pfm", sky)
    write_pfm(folder / "turned.pfm", np.roll(sky, 128, axis=1))
    triangles = read_ply(meshes / "dragon.ply")
    (low, high) = triangles.min((0, 1)), triangles.max((0, 1))
    middle, size = (low + high) / 2, np.linalg.norm(high - low)
    eye = middle + size * np.array((0.3, 0.2, 0.9))
    dragon = Scene("glossy dragon under an environment", 8, eye=eye, direction=middle - eye, fov=50)
    write_ply(folder / "dragon.ply", triangles)
    roughness = 0.3
    mesh(dragon, folder / "dragon.ply", (
        f"PrincipledMaterial {{ baseColor 1 1 1 baseMetalness 1 specularRoughness {roughness} }}",
        {"type": "roughconductor", "distribution": "ggx", "alpha": roughness**2, "material": "none"}))
    dragon.rectangle((-50, low[1], 50), (100, 0, 0), (0, 0, -100), matte((0.4, 0.4, 0.4)))
    dragon.environment = "environment sky.pfm"
    dragon.theirs["env"] = {"type": "envmap", "filename": str(folder / "turned.pfm")}
    yield dragon

    for name in ("kitchen", "hall"):
        triangles = read_ply(meshes / f"{name}.ply")
        (low, high) = triangles.min((0, 1)), triangles.max((0, 1))
        size, forward = high - low, np.array((0.8, -0.1, 0.59))
        eye = (low + high) / 2 - 0.15 * size * forward
        room = Scene(f"{name} with lights", 8, eye=eye, direction=forward, fov=70)
        write_ply(folder / f"{name}.ply", triangles)
        mesh(room, folder / f"{name}.ply", matte((0.6, 0.6, 0.6)))
        for x, z in itertools.product((0.35, 0.65), (0.4, 0.6)):
            corner = low + size * np.array((x, 0.75, z))
            room.rectangle(corner, (0.08 * size[0], 0, 0), (0, 0, 0.05 * size[2]), None, (20, 18, 15))
        yield room

    random = np.random.default_rng(1)
    count = 100_000
    centers = random.uniform((-8, 3, -8), (8, 5, 8), (count, 3))
    # The lights face down, above the visible part. Visible lights far smaller than a pixel would
    # dominate the noise.
    corner = 0.004 * np.array(((0, 0, 0), (1, 0, 0), (0, 0, 1)))
    write_ply(folder / "lamps.ply", centers[:, None, :] + corner)
    many = Scene("100,000 small lights", 8, eye=(0, 2.5, 9), direction=(0, -0.5, -1), fov=50)
    many.rectangle((-50, 0, 50), (100, 0, 0), (0, 0, -100), matte((0.5, 0.4, 0.3)))
    mesh(many, folder / "lamps.ply", None, (300, 250, 200))
    for x in range(-3, 4):
        many.sphere((2 * x, 0.5, 2 * (x % 3)), 0.5, matte((0.6, 0.6, 0.6)))
    yield many


def error(pictures):
    """Returns the mean squared error of one picture, estimated from pairs of pictures."""
    return np.mean([((a - b) ** 2).mean() / 2 for a, b in itertools.combinations(pictures, 2)])


# Samplers of Mitsuba, and the depths from which it ends paths by Russian roulette: its default, and
# never. `stratified` is left out because `multijitter` stratifies more dimensions.
SETTINGS = list(itertools.product(("multijitter", "orthogonal", "ldsampler"), (5, 1000)))


def samples_of(sampler, samples):
    """Returns the number of samples that a sampler takes if `samples` are asked for: `orthogonal`
    takes the square of the next prime."""
    if sampler != "orthogonal":
        return samples
    side = next(n for n in itertools.count(2) if n * n >= samples and all(n % k for k in range(2, n)))
    return side * side


def power_of_two(samples):
    """Returns the smallest power of two that is at least `samples`."""
    return 1 << (samples - 1).bit_length()


def spent(work):
    """Returns the result of `work` and its CPU time, including child processes."""
    def now():
        return time.process_time() + sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    start = now()
    return work(), now() - start


def race(given, scene, folder):
    source, picture = folder / "scene.txt", folder / "picture.pfm"
    text = scene.text
    environment = getattr(scene, "environment", None)
    source.write_text(text.replace("Background { color", f"Background {{ {environment} color") if environment else text)
    side = given.side

    def ours(samples, seed, *options):
        subprocess.run([given.program, "render", source, "-o", picture, "--size", f"{side}x{side}", "--samples", str(samples), "--filter", "box",
                        "--integrator", "path", "--bounces", str(scene.bounces), "--seed", str(seed), "--threads", str(given.threads),
                        "-q", "--restart", *options], check=True)
        return read_pfm(picture)

    scene.theirs["sensor"]["film"].update(width=side, height=side)

    def theirs(sampler, roulette):
        scene.theirs["sensor"]["sampler"] = {"type": sampler, "sample_count": samples_of(sampler, given.samples)}
        scene.theirs["integrator"]["rr_depth"] = roulette
        loaded = mi.load_dict(scene.theirs)
        work = lambda samples, seed: np.array(mi.render(loaded, spp=samples, seed=seed)).astype(float)
        work(given.samples, 1000)
        return work

    start = min(spent(lambda: ours(1, 0))[1] for _ in range(2))
    own_count = {sampler: power_of_two(samples_of(sampler, given.samples)) for sampler, _ in SETTINGS}
    programs = {(name, count): (program, count) for count in set(own_count.values()) for name, program in [
        (scene.name, ours), ("with `--adaptive`", lambda samples, seed: ours(samples, seed, "--adaptive"))]}
    programs |= {one: (theirs(*one), samples_of(one[0], given.samples)) for one in SETTINGS}
    made = {name: [] for name in programs}
    for seed in range(given.runs):
        for name, (program, count) in programs.items():
            made[name].append(spent(lambda: program(count, seed)))
    # Time, mean squared error and mean of each program.
    figures = {}
    for name, runs in made.items():
        pictures = [picture for picture, _ in runs]
        figures[name] = np.array([min(time for _, time in runs), error(pictures), np.mean(pictures)])
    for name in (scene.name, "with `--adaptive`"):
        # The setting with which Mitsuba compares best.
        def ratio(one):
            t, e, _ = figures[name, own_count[one[0]]] - (start, 0, 0)
            return t * e / (figures[one][0] * figures[one][1])
        best = max(SETTINGS, key=ratio)
        count = own_count[best[0]]
        (t, e, m), (time, noise, mean) = figures[name, count] - (start, 0, 0), figures[best]
        print(f"| {name} | {t:.2f} s | {time:.2f} s | {best[0]}, {best[1]}, {samples_of(best[0], given.samples)} | {count} | {100 * np.sqrt(e) / mean:.2f} % | "
              f"{100 * np.sqrt(noise) / mean:.2f} % | {m / mean:.4f} | **{ratio(best):.2f}** |", flush=True)


def begun(**numbers):
    """Parses the options (`numbers` are integers with their defaults) and initialises Mitsuba."""
    arguments = argparse.ArgumentParser()
    arguments.add_argument("program")
    arguments.add_argument("meshes", type=pathlib.Path)
    for name, value in numbers.items():
        arguments.add_argument(f"--{name}", type=int, default=value)
    arguments.add_argument("--only", default="")
    given = arguments.parse_args()
    mi.set_variant("llvm_ad_rgb")
    dr.set_thread_count(given.threads)
    return given


def each(given, scenes, race):
    """Runs `race` for each selected scene."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for scene in scenes(given.meshes, folder):
            if given.only in scene.name:
                race(given, scene, folder)


def main():
    given = begun(side=256, samples=64, runs=5, threads=2)
    print(f"{given.side} x {given.side} pixels, {given.samples} samples, {given.threads} threads each, {given.runs} runs in turns, Mitsuba {mi.__version__}\n\n"
          "| scene | ours | Mitsuba | its sampler, roulette from, samples | our samples | our error | its error | mean, ours over its | time to equal error, ours over its |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    each(given, scenes, race)


if __name__ == "__main__":
    main()
