"""Compares the time and memory of renders by Dürer and POV-Ray 3.7, with the same scenes and
numbers of samples, in turns.

    python3 bench_pictures.py DURER DRAGON.ply [--runs 3] [--threads 2] [--side 512] [--only TEXT]

Dürer uses 16 samples per pixel and the default filter. POV-Ray renders four times the width and
height without anti-aliasing, which traces as many rays at its lowest cost. Memory is measured on
pictures of equal size with one sample. The means of small pictures in linear light check that both
programs show the same.
"""

import argparse
import math
import os
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib


def words(values):
    return " ".join(f"{v:.6g}" for v in values)


def vector(values):
    """Formats a vector for POV-Ray, whose axes are left-handed: z is negated."""
    x, y, z = values
    return f"<{x:.6g},{y:.6g},{-z:.6g}>"


class Scene:
    """A scene for both programs: text for Dürer, and text for POV-Ray."""

    def __init__(self, name, eye, direction, angle, background, ambient, bounces=8, options=()):
        self.name, self.bounces, self.options = name, bounces, list(options)
        target = [e + d for e, d in zip(eye, direction)]
        self.camera = f"PerspectiveCamera {{ center {words(eye)} direction {words(direction)} up 0 1 0 angle {angle} }}"
        self.background = f"Background {{ color {words(background)} ambientLight {words(ambient)} }}"
        self.lights, self.materials, self.objects = [], [], []
        r, g, b = ambient
        self.theirs = [
            "#version 3.7;",
            f"global_settings {{ assumed_gamma 1 max_trace_level {bounces + 1} adc_bailout 1/256 ambient_light rgb <{r},{g},{b}> }}",
            f"camera {{ perspective location {vector(eye)} up y right x angle {angle} look_at {vector(target)} }}",
            f"background {{ rgb <{','.join(map(str, background))}> }}",
        ]

    def point_light(self, place, color):
        self.lights.append(f"PointLight {{ position {words(place)} color {words(color)} }}")
        self.theirs.append(f"light_source {{ {vector(place)} rgb <{','.join(map(str, color))}> }}")

    def material(self, diffuse, specular=0.0, exponent=1, mirror=0.0, glass=None):
        """Adds a material and returns its index and POV-Ray's text. The highlight is Blinn's with
        strength `specular`; POV-Ray's roughness is 1 / exponent."""
        text = f"PhongMaterial {{ diffuseColor {words(diffuse)} specularColor {words([specular] * 3)} exponent {exponent}"
        color, finish = ",".join(map(str, diffuse)), f"ambient 1 diffuse 1 specular {specular} roughness {1 / exponent:.6g}"
        if glass is not None:
            text += f" transparentColor 1 1 1 refractionIndex {glass}"
            theirs = (f"pigment {{ rgbf 1 }} finish {{ ambient 0 diffuse 0 specular {specular} roughness {1 / exponent:.6g} "
                      f"reflection {{ 0, 1 fresnel on }} conserve_energy }} interior {{ ior {glass} }}")
        else:
            text += f" reflectiveColor {words([mirror] * 3)}" if mirror else ""
            theirs = f"pigment {{ rgb <{color}> }} finish {{ {finish} {f'reflection {mirror}' if mirror else ''} }}"
        self.materials.append(text + " }")
        return len(self.materials) - 1, theirs

    def put(self, material, ours, theirs):
        """Adds an object; `theirs` is its text for POV-Ray without the last brace."""
        self.objects.append(f"MaterialIndex {material[0]} {ours}")
        self.theirs.append(f"{theirs} {material[1]} }}")

    def sphere(self, material, center, radius):
        self.put(material, f"Sphere {{ center {words(center)} radius {radius:.6g} }}", f"sphere {{ {vector(center)}, {radius:.6g}")

    def plane(self, material, normal, offset):
        self.put(material, f"Plane {{ normal {words(normal)} offset {offset} }}", f"plane {{ {vector(normal)}, {offset}")

    def text(self):
        return "\n".join([self.camera, self.background, f"Lights {{ {' '.join(self.lights)} }}",
                          f"Materials {{ {chr(10).join(self.materials)} }}", f"Group {{ {chr(10).join(self.objects)} }}", ""])


def sphere(_):
    s = Scene("sphere", (0, 0, 10), (0, 0, -1), 26, (0.02, 0.025, 0.035), (0.06, 0.06, 0.08))
    s.point_light((10, 12, 10), (1, 0.97, 0.92))
    s.sphere(s.material((0.65, 0.08, 0.06), 0.5, 60), (0, 0, 0), 1.6)
    return s


def whitted(_):
    s = Scene("whitted", (0, 1.7, 9), (0, -0.07, -1), 34, (0.10, 0.26, 0.55), (0.14, 0.15, 0.18), options=["--transparent-shadows"])
    s.point_light((-6, 10, 7), (1, 0.98, 0.94))
    s.plane(s.material((0.7, 0.3, 0.06)), (0, 1, 0), 0)
    s.sphere(s.material((0, 0, 0), 1, 600, glass=1.5), (-0.75, 1.85, 1.6), 1.05)
    s.sphere(s.material((0.04, 0.04, 0.05), 0.9, 300, mirror=0.74), (1.15, 1.2, -1.6), 1.2)
    return s


def hall(_):
    s = Scene("hall of mirrors", (1.9, 1.9, 3.4), (-1, -0.11, -0.72), 66, (0.01, 0.01, 0.015), (0.05, 0.045, 0.05), bounces=20)
    for z in (2, -2, -6):
        s.point_light((0, 3.1, z), (0.4, 0.3, 0.2))
    s.plane(s.material((0.5, 0.4, 0.3), 0.2, 60), (0, 1, 0), 0)
    wall = s.material((0.45, 0.43, 0.42))
    s.plane(wall, (0, -1, 0), -4)
    s.plane(wall, (0, 0, 1), -9)
    mirror = s.material((0.01, 0.012, 0.01), mirror=0.85)
    s.plane(mirror, (1, 0, 0), -2.5)
    s.plane(mirror, (-1, 0, 0), -2.5)
    gold = s.material((0.5, 0.32, 0.08), 0.6, 50)
    for center, radius in (((-0.6, 0.55, 0.4), 0.55), ((0.75, 0.4, -1.6), 0.4), ((-0.4, 0.45, -4.2), 0.45)):
        s.sphere(gold, center, radius)
    return s


def read_ply(path):
    """Reads vertices and triangles from a binary PLY file of floats and triangles."""
    data = pathlib.Path(path).read_bytes()
    head, body = data.split(b"end_header\n", 1)
    counts = {line.split()[1]: int(line.split()[2]) for line in head.split(b"\n") if line.startswith(b"element")}
    corners = [struct.unpack_from("<3f", body, 12 * i) for i in range(counts[b"vertex"])]
    start = 12 * len(corners)
    return corners, [struct.unpack_from("<3i", body, start + 13 * i + 1) for i in range(counts[b"face"])]


def dragon(folder):
    s = Scene("dragon", (0.3, 0.9, 3.2), (-0.1, -0.2, -1), 36, (0.3, 0.35, 0.4), (0.1, 0.1, 0.1), bounces=1)
    s.point_light((4, 6, 4), (0.6, 0.58, 0.55))
    s.point_light((-5, 4, 3), (0.3, 0.3, 0.34))
    corners, triangles = read_ply(folder / "dragon.ply")
    low = [min(c[i] for c in corners) for i in range(3)]
    high = [max(c[i] for c in corners) for i in range(3)]
    scale = 2 / max(h - l for l, h in zip(low, high))
    middle = [(l + h) / 2 for l, h in zip(low, high)]
    corners = [((x - middle[0]) * scale, (y - low[1]) * scale, (z - middle[2]) * scale) for x, y, z in corners]
    with open(folder / "dragon.obj", "w") as out:
        out.writelines(f"v {words(c)}\n" for c in corners)
        out.writelines(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles)
    mesh = "mesh2 { vertex_vectors { %d, %s } face_indices { %d, %s }" % (
        len(corners), ",".join(map(vector, corners)), len(triangles), ",".join(f"<{a},{b},{c}>" for a, b, c in triangles))
    s.put(s.material((0.4, 0.5, 0.3), 0.4, 40), "TriangleMesh { obj_file dragon.obj }", mesh)
    s.plane(s.material((0.5, 0.5, 0.5), mirror=0.2), (0, 1, 0), 0)
    return s


def gear(_):
    s = Scene("gear of solids", (0.05, 6.2, 5.2), (-0.01, -1.2, -1), 30, (0.55, 0.6, 0.66), (0.14, 0.14, 0.16))
    s.point_light((-4, 8, 3), (0.7, 0.68, 0.6))
    s.plane(s.material((0.3, 0.33, 0.36)), (0, 1, 0), -0.02)
    ours, theirs = ["Cylinder { base 0 0 0 top 0 0.45 0 radius 1.56 }"], ["cylinder { <0,0,0>, <0,0.45,0>, 1.56 }"]
    for i in range(18):
        ours.append(f"Transform {{ YRotate {20 * i} Box {{ min 1.3 0 -0.15 max 2 0.45 0.15 }} }}")
        theirs.append(f"box {{ <1.3,0,-0.15>, <2,0.45,0.15> rotate y*{-20 * i} }}")
    holes, theirs_holes = ["Cylinder { base 0 -1 0 top 0 1 0 radius 0.4 }"], ["cylinder { <0,-1,0>, <0,1,0>, 0.4 }"]
    for i in range(6):
        x, z = math.cos(i * math.pi / 3), math.sin(i * math.pi / 3)
        holes.append(f"Cylinder {{ base {words((x, -1, z))} top {words((x, 1, z))} radius 0.25 }}")
        theirs_holes.append(f"cylinder {{ {vector((x, -1, z))}, {vector((x, 1, z))}, 0.25 }}")
    s.put(s.material((0.55, 0.36, 0.1), 0.6, 60, mirror=0.15),
          f"Difference {{ Merge {{ {' '.join(ours)} }} {' '.join(holes)} }}",
          f"difference {{ merge {{ {' '.join(theirs)} }} {' '.join(theirs_holes)}")
    return s


def height_field(folder):
    s = Scene("height field", (0.5, 0.9, 1.6), (0, -0.6, -1), 45, (0.4, 0.5, 0.65), (0.15, 0.15, 0.18))
    s.point_light((3, 4, 2), (0.9, 0.85, 0.75))
    side = 257
    level = lambda x, y: 0.5 + 0.2 * math.sin(9 * x + 4 * y) + 0.15 * math.sin(17 * y - 6 * x) + 0.1 * math.sin(37 * x) * math.sin(31 * y)
    rows = [[max(0, min(255, int(255 * level(x / side, y / side)))) for x in range(side)] for y in range(side)]
    raw = b"".join(b"\0" + bytes(row) for row in rows)
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    head = struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)
    (folder / "hills.png").write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"gAMA", struct.pack(">I", 100000))
                                       + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))
    s.put(s.material((0.45, 0.4, 0.3)), "HeightField { picture hills.png min 0 0 0 max 1 0.25 1 }",
          'height_field { png "hills.png" gamma 1 scale <1,0.25,1> translate <0,0,-1>')
    return s


def glass_balls(_):
    s = Scene("1,000 glass balls", (6, 5, 14), (-0.42, -0.3, -1), 40, (0.3, 0.4, 0.6), (0.1, 0.1, 0.1), options=["--transparent-shadows"])
    s.point_light((-8, 14, 10), (0.9, 0.9, 0.85))
    s.plane(s.material((0.5, 0.45, 0.4)), (0, 1, 0), -5)
    glass, numbers = s.material((0, 0, 0), 0.8, 300, glass=1.5), random.Random(1)
    for i in range(1000):
        place = [c - 4.5 + 0.2 * numbers.random() for c in (i % 10, i // 10 % 10, i // 100)]
        s.sphere(glass, place, 0.3 + 0.1 * numbers.random())
    return s


SCENES = [sphere, whitted, hall, dragon, gear, height_field, glass_balls]


def run(command, folder, peak=False):
    """Runs a command. Returns CPU seconds, wall-clock seconds and, if `peak`, peak memory in bytes."""
    start, most = os.times().elapsed, 0
    with open(folder / "errors.txt", "w+b") as errors:
        process = subprocess.Popen([str(c) for c in command], cwd=folder, stdout=subprocess.DEVNULL, stderr=errors)
        # The peak memory from wait4 would include this process before exec.
        while peak and (os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT)) is None:
            try:
                status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
                most = max([most] + [1024 * int(line.split()[1]) for line in status.split("\n") if line.startswith("VmHWM")])
            except OSError:
                pass
            time.sleep(0.002)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = status
        if status != 0:
            errors.seek(0)
            sys.exit(f"{' '.join(map(str, command))} failed:\n{errors.read().decode(errors='replace')[-2000:]}")
    return used.ru_utime + used.ru_stime, os.times().elapsed - start, most


def ours(durer, s, side, samples, threads, picture):
    return [durer, "render", "scene.txt", "--size", f"{side}x{side}", "--samples", samples, "--threads", threads, "--bounces", s.bounces,
            "--integrator", "whitted", "--quiet", *s.options, "-o", picture]


def theirs(side, threads, picture):
    kind = "+FP" if picture.endswith(".ppm") else "+FN"
    return ["povray", "+Iscene.pov", f"+O{picture}", kind, f"+W{side}", f"+H{side}", "-D", "-A", "File_Gamma=srgb",
            f"Work_Threads={threads}"]


def mean(path):
    """Returns the mean of a PPM file in linear light."""
    data = path.read_bytes()
    fields, at = [], 0
    while len(fields) < 4:
        end = at
        while data[end:end + 1] not in (b" ", b"\n", b"\t"):
            end += 1
        if data[at:end].startswith(b"#"):
            end = data.index(b"\n", at)
        elif end > at:
            fields.append(data[at:end])
        at = end + 1
    linear = [v / 255 / 12.92 if v <= 10 else ((v / 255 + 0.055) / 1.055) ** 2.4 for v in range(256)]
    pixels = data[at:]
    return sum(linear[v] for v in pixels) / len(pixels)


def median(values):
    return sorted(values)[len(values) // 2]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("durer", type=pathlib.Path)
    parser.add_argument("dragon", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--side", type=int, default=512)
    parser.add_argument("--only", default="")
    given = parser.parse_args()
    durer = given.durer.resolve()
    if shutil.which("povray") is None:
        sys.exit("bench-pictures needs POV-Ray 3.7 (Debian's package `povray`)")
    print("| scene | CPU s | POV-Ray | ratio | wall s | POV-Ray | peak MB | POV-Ray | mean | POV-Ray |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    logs = []
    for make in SCENES:
        if given.only not in make.__name__:
            continue
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "dragon.ply").symlink_to(given.dragon.resolve())
            s = make(folder)
            (folder / "scene.txt").write_text(s.text())
            (folder / "scene.pov").write_text("\n".join(s.theirs) + "\n")
            run(ours(durer, s, 96, 16, 1, "a.ppm"), folder)
            run(theirs(384, 1, "b.ppm"), folder)
            means = mean(folder / "a.ppm"), mean(folder / "b.ppm")
            a, b = [], []
            for _ in range(given.runs):
                a.append(run(ours(durer, s, given.side, 16, given.threads, "a.png"), folder))
                b.append(run(theirs(4 * given.side, given.threads, "b.png"), folder))
            memory = (run(ours(durer, s, 2 * given.side, 1, given.threads, "a.png"), folder, True)[2],
                      run(theirs(2 * given.side, given.threads, "b.png"), folder, True)[2])
            ratio = median([x[0] / y[0] for x, y in zip(a, b)])
            logs.append(math.log(ratio))
            cpu, wall = [[median([r[i] for r in runs]) for runs in (a, b)] for i in (0, 1)]
            print(f"| {s.name} | {cpu[0]:.2f} | {cpu[1]:.2f} | {ratio:.3f} | {wall[0]:.2f} | {wall[1]:.2f} | {memory[0] / 1e6:.0f} "
                  f"| {memory[1] / 1e6:.0f} | {means[0]:.4f} | {means[1]:.4f} |", flush=True)
    if logs:
        print(f"\nGeometric mean of the CPU ratios: {math.exp(sum(logs) / len(logs)):.3f}")


main()
