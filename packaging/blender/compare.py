"""Installs the add-on in Blender, renders ten scenes with it and with Cycles, and compares the
pictures.

    python compare.py ADDON.zip [--only TEXT] [--samples 256] [--side 128] [--threads 2] [--keep
    FOLDER] [--table FILE]

Both engines have a box filter, the same number of bounces and no clamping, adaptive sampling or
denoising. The command fails if the means of a scene, or its mean FLIP, differ by more than the scene
allows.
"""

import argparse
import os
import pathlib
import sys
import tempfile
import time

FOLDER = tempfile.TemporaryDirectory()
# Blender keeps its extensions there, so that those of the user do not change.
os.environ["BLENDER_USER_RESOURCES"] = FOLDER.name

import bpy  # noqa: E402
import durer  # noqa: E402
import numpy as np  # noqa: E402
from scenes import SCENES  # noqa: E402

ADDON = "bl_ext.user_default.durer_blender"


def prepare(engine, build, given):
    """Builds a scene in an empty file, with equal settings for both engines."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module=ADDON)
    scene = bpy.context.scene
    render, cycles, own = scene.render, scene.cycles, scene.durer
    render.engine = engine
    render.resolution_x = render.resolution_y = given.side
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", given.threads
    cycles.device, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", False, False
    cycles.samples = own.samples = given.samples
    cycles.pixel_filter_type, own.filter, own.filter_width = "BOX", "BOX", 1
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    for name in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces", "transparent_max_bounces"):
        setattr(cycles, name, 12)
    own.bounces = 12
    build()


def picture(engine, build, given, file):
    """Renders a scene. Returns the linear pixels with the top row first, and the time in seconds."""
    prepare(engine, build, given)
    settings = bpy.context.scene.render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGBA"
    bpy.context.scene.render.filepath = str(file)
    start = time.monotonic()
    bpy.ops.render.render(write_still=True)
    spent = time.monotonic() - start
    image = bpy.data.images.load(str(file))
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], 4)[::-1], spent


def display(values):
    """Converts linear light to 8-bit sRGB values."""
    values = np.clip(values[..., :3], 0, 1)
    curved = np.where(values <= 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055)
    return np.rint(curved * 255).astype(np.uint8)


def save(folder, name, theirs, ours):
    """Saves Cycles, Dürer, and ten times their difference side by side."""
    off = np.abs(theirs - ours)[..., :3] * 10
    row = np.concatenate([display(theirs), display(ours), display(off)], 1)
    row = np.repeat(np.repeat(row, 3, 0), 3, 1)
    image = bpy.data.images.new(name, row.shape[1], row.shape[0])
    image.pixels.foreach_set(np.append(row[::-1] / np.float32(255), np.ones_like(row[..., :1], np.float32), -1).ravel())
    image.filepath_raw, image.file_format = str(pathlib.Path(folder) / f"{name.replace(' ', '-')}.png"), "PNG"
    image.save()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("addon")
    parser.add_argument("--only", default="", help="texts in the names of scenes, separated by commas")
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--side", type=int, default=128)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--keep")
    parser.add_argument("--table")
    given = parser.parse_args()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.extensions.package_install_files(filepath=given.addon, repo="user_default", enable_on_install=True)
    if given.keep:
        pathlib.Path(given.keep).mkdir(parents=True, exist_ok=True)
    rows, failed = [], 0
    for name, (build, most_off, most_flip) in SCENES.items():
        if not any(text in name for text in given.only.split(",")):
            continue
        theirs, slow = picture("CYCLES", build, given, pathlib.Path(FOLDER.name) / "cycles.exr")
        ours, quick = picture("DURER", build, given, pathlib.Path(FOLDER.name) / "durer.exr")
        if given.keep:
            save(given.keep, name, theirs, ours)
        ratios = ours.mean((0, 1)) / np.maximum(theirs.mean((0, 1)), 1e-9)
        worst = ratios[np.abs(ratios - 1).argmax()]
        flip = durer.compare(theirs[..., :3], ours[..., :3])["flip_map"].mean()
        passes = abs(worst - 1) <= most_off and flip <= most_flip
        failed += not passes
        what = " ".join(build.__doc__.split()).rstrip(".")
        figures = f"{ratios[:3].mean():.4f} | {worst:.4f} | {flip:.4f}"
        rows.append(f"| {name}: {what[0].lower()}{what[1:]} | {figures} | {most_off:.0%}, {most_flip:g} |")
        verdict = "passes" if passes else "FAILS"
        print(f"{verdict} {name}: mean {ratios[:3].mean():.4f}, worst channel {worst:.4f}, FLIP {flip:.4f}, ", end="")
        print(f"{slow:.1f} s by Cycles and {quick:.1f} s by Dürer", flush=True)
    if given.table:
        version = ".".join(str(number) for number in bpy.app.version)
        head = f"Blender {version}, {given.side} x {given.side} pixels, {given.samples} samples, 12 bounces, box filter:\n\n"
        head += "| scene | mean, Dürer / Cycles | worst channel | FLIP, mean | allowed |\n| --- | --- | --- | --- | --- |\n"
        pathlib.Path(given.table).write_text(head + "\n".join(rows) + "\n")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
