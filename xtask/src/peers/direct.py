"""Compares the cost of direct light from point lights: Dürer's `whitted`, Mitsuba 3's `direct` and
Blender's Cycles on equal scenes.

    python direct.py DURER MESHES [--side 512] [--samples 16] [--runs 3] [--threads 2] [--only
    TEXT]

The programs render each scene in turn, with the same camera, filter and number of samples, one hit
deep with its lights. Time is the CPU time of all threads: for Dürer minus that of a picture with
one sample, which covers reading and building; for Mitsuba after a first picture, which compiles;
for Cycles minus one sample. Figures use the minimum time of the runs. The means check that all show
the same. With two lights, Dürer samples both at each hit and the others one: their samples are
cheaper, but noisy.

Cycles is skipped if Blender (the package `bpy`) is missing, and for scenes with spheres, which it
supports only as meshes.
"""

import json
import math
import pathlib
import subprocess
import sys
import time


def cycles(path):
    """Runs in a process of its own: renders the scene in a file, prints the times, and saves the
    picture."""
    import bpy
    import mathutils
    import numpy as np
    given = json.loads(pathlib.Path(path).read_text())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    collection = scene.collection.objects
    for number, (position, color) in enumerate(given["lamps"]):
        # In watts, so that a white surface at distance 1 that faces the light has the light's colour.
        lamp = bpy.data.lights.new(f"lamp{number}", "POINT")
        lamp.energy, lamp.color, lamp.shadow_soft_size, lamp.use_soft_falloff = 4 * math.pi**2, color, 0, False
        place = bpy.data.objects.new(f"lamp{number}", lamp)
        place.location = position
        collection.link(place)
    for number, (file, color) in enumerate(given["meshes"]):
        corners = np.load(file)
        mesh = bpy.data.meshes.new(f"mesh{number}")
        mesh.from_pydata(corners.reshape(-1, 3).tolist(), [], np.arange(corners.size // 3).reshape(-1, 3).tolist())
        material = bpy.data.materials.new(f"matte{number}")
        material.use_nodes = True
        nodes = material.node_tree.nodes
        nodes.clear()
        surface, end = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
        surface.inputs["Color"].default_value = (*color, 1)
        material.node_tree.links.new(surface.outputs["BSDF"], end.inputs["Surface"])
        mesh.materials.append(material)
        collection.link(bpy.data.objects.new(f"mesh{number}", mesh))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.angle = math.radians(given["fov"])
    camera.rotation_euler = mathutils.Vector(given["direction"]).to_track_quat("-Z", "Y").to_euler()
    camera.location = given["eye"]
    collection.link(camera)
    scene.camera = camera
    render, settings = scene.render, scene.cycles
    render.engine = "CYCLES"
    settings.device, settings.use_adaptive_sampling, settings.use_denoising = "CPU", False, False
    settings.max_bounces, settings.pixel_filter_type = 0, "BOX"
    render.resolution_x = render.resolution_y = given["side"]
    render.threads_mode, render.threads = "FIXED", given["threads"]
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.filepath = given["picture"]

    def spent(samples):
        settings.samples = samples
        start = time.process_time()
        bpy.ops.render.render(write_still=True)
        return time.process_time() - start

    one = min(spent(1) for _ in range(3))
    times = [spent(given["samples"]) for _ in range(given["runs"])]
    print("\n" + json.dumps(min(times) - one))


def scenes(meshes, folder):
    """Yields scenes with point lights and triangles; a scene with a sphere has no triangles."""
    import numpy as np
    from own import Scene
    from speed import mesh, read_ply, write_ply

    def phong(c):
        return (f"PhongMaterial {{ diffuseColor {c[0]} {c[1]} {c[2]} specularColor 0 0 0 }}",
                {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(c)}})

    def begun(name, eye, direction, fov, lamps):
        scene = Scene(name, 1, eye=eye, direction=direction, fov=fov)
        scene.theirs["integrator"] = {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}
        scene.pose, scene.lamps, scene.triangles = (eye, direction, fov), lamps, []
        for number, (place, color) in enumerate(lamps):
            where = " ".join(map(str, place)), " ".join(map(str, color))
            scene.lights.append(f"PointLight {{ position {where[0]} color {where[1]} attenuation 0 0 1 }}")
            intensity = {"type": "rgb", "value": [math.pi * c for c in color]}
            scene.theirs[f"lamp{number}"] = {"type": "point", "position": list(place), "intensity": intensity}
        return scene

    def put(scene, corners, color):
        path = folder / f"{scene.name}{len(scene.triangles)}.ply".replace(" ", "_")
        write_ply(path, corners)
        np.save(path.with_suffix(".npy"), corners)
        mesh(scene, path, phong(color))
        scene.triangles.append((str(path.with_suffix(".npy")), color))

    def floor(scene, height, color):
        a, b, c, d = [(x, height, z) for x, z in ((-50, 50), (50, 50), (50, -50), (-50, -50))]
        put(scene, np.array([[a, b, c], [a, c, d]], float), color)

    ball = begun("sphere", (0, 0, 10), (0, 0, -1), 26, [((10, 12, 10), (300, 290, 275))])
    ball.sphere((0, 0, 0), 1.6, phong((0.65, 0.08, 0.06)))
    ball.triangles = None
    yield ball

    dragon = begun("dragon", (0.3, 0.9, 3.2), (-0.1, -0.2, -1), 36, [((4, 6, 4), (40, 38, 36)), ((-5, 4, 3), (15, 15, 17))])
    triangles = read_ply(meshes / "dragon.ply").astype(float)
    low, high = triangles.min((0, 1)), triangles.max((0, 1))
    put(dragon, (triangles - [(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2]) * 2 / (high - low).max(), (0.4, 0.5, 0.3))
    floor(dragon, 0, (0.5, 0.5, 0.5))
    yield dragon

    hills = begun("height field", (0.5, 0.9, 1.6), (0, -0.6, -1), 45, [((3, 4, 2), (26, 25, 22))])
    x, z = np.meshgrid(np.linspace(0, 1, 257), np.linspace(0, 1, 257))
    y = 0.25 * (0.5 + 0.2 * np.sin(9 * x + 4 * z) + 0.15 * np.sin(17 * z - 6 * x) + 0.1 * np.sin(37 * x) * np.sin(31 * z))
    grid = np.stack((x, y, z), 2)
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    put(hills, np.concatenate([np.stack(t, 2).reshape(-1, 3, 3) for t in ((a, b, c), (a, c, d))]), (0.45, 0.4, 0.3))
    yield hills

    kitchen = read_ply(meshes / "kitchen.ply").astype(float)
    low, high = kitchen.min((0, 1)), kitchen.max((0, 1))
    size, forward = high - low, np.array((0.8, -0.1, 0.59))
    eye = (low + high) / 2 - 0.15 * size * forward
    lamps = [(tuple(low + size * (x, 0.75, z)), tuple(0.05 * (size @ size) * np.array((1, 0.9, 0.8)))) for x, z in ((0.35, 0.4), (0.65, 0.6))]
    room = begun("kitchen", tuple(eye), tuple(forward), 70, lamps)
    put(room, kitchen, (0.6, 0.6, 0.6))
    yield room


def race(given, scene, folder):
    import mitsuba as mi
    import numpy as np
    from picture import read_pfm
    from speed import spent
    source, picture = folder / "scene.txt", folder / "picture.pfm"
    source.write_text(scene.text)

    def ours(samples):
        subprocess.run([given.program, "render", source, "-o", picture, "--size", f"{given.side}x{given.side}", "--samples", str(samples),
                        "--filter", "box", "--integrator", "whitted", "--threads", str(given.threads), "-q", "--restart"], check=True)

    scene.theirs["sensor"]["film"].update(width=given.side, height=given.side)
    loaded = mi.load_dict(scene.theirs)
    theirs = lambda samples, seed: np.array(mi.render(loaded, spp=samples, seed=seed)).astype(float)
    theirs(given.samples, 0)
    one = min(spent(lambda: ours(1))[1] for _ in range(3))
    own, other = [], []
    for seed in range(given.runs):
        own.append(spent(lambda: ours(given.samples))[1] - one)
        drawn, took = spent(lambda: theirs(given.samples, seed))
        other.append(took)
    means = [read_pfm(picture).mean(), drawn.mean()]
    row = [f"{min(own):.2f} s", f"{min(other):.2f} s", f"**{min(own) / min(other):.2f}**"]
    if scene.triangles is None:
        row += ["", ""]
    else:
        eye, direction, fov = scene.pose
        told = {"lamps": scene.lamps, "meshes": scene.triangles, "eye": eye, "direction": direction, "fov": fov, "side": given.side,
                "samples": given.samples, "threads": given.threads, "runs": given.runs, "picture": str(folder / "cycles.exr")}
        (folder / "cycles.json").write_text(json.dumps(told, default=float))
        done = subprocess.run([sys.executable, __file__, "--cycles", folder / "cycles.json"], capture_output=True, text=True)
        if done.returncode != 0:
            row += [(done.stderr.strip().splitlines() or ["failed"])[-1], ""]
        else:
            seconds = json.loads(done.stdout.strip().splitlines()[-1])
            row += [f"{seconds:.2f} s", f"**{min(own) / seconds:.2f}**"]
            exr = mi.Bitmap(told["picture"]).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
            means.append(np.array(exr).mean())
    print(f"| {scene.name} | {' | '.join(row)} | {', '.join(f'{m:.4f}' for m in means)} |", flush=True)


def main():
    if sys.argv[1:2] == ["--cycles"]:
        return cycles(sys.argv[2])
    import speed
    given = speed.begun(side=512, samples=16, runs=3, threads=2)
    print(f"{given.side} x {given.side} pixels, {given.samples} samples, {given.threads} threads each, {given.runs} runs in turns, "
          f"Mitsuba {speed.mi.__version__}\n\n| scene | ours | Mitsuba | ours over its | Cycles | ours over its | means |\n"
          "| --- | --- | --- | --- | --- | --- | --- |")
    speed.each(given, scenes, race)


if __name__ == "__main__":
    main()
