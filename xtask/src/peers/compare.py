"""Compares renders of the same scenes by Dürer and Mitsuba 3.

    python compare.py DURER [--only TEXT] [--jobs 2] [--table FILE] [--keep FOLDER]

Both programs read the same XML file, and render it several times with different seeds until the
standard error of the ratio of the mean is below 0.2 %. A scene agrees if the mean of each channel
agrees within 0.5 % or three standard errors, and if no block of 8 x 8 pixels differs: a block
differs if its mean is off by more than 0.5 % and its Student's t, as a normal deviate, exceeds the
two-sided limit for a significance of 0.01 over all blocks and channels (Sidak's correction). What
Dürer warns of must be what the scene says it warns of.
"""

import argparse
import concurrent.futures
import multiprocessing
import pathlib
import re
import subprocess
import tempfile
import time

import mitsuba as mi
import numpy as np

import assets
import own
from judge import RUNS, Judgement
from picture import read_pfm
from scene import Verdict, scenes

SAMPLES = 16
MOST_RUNS = 32
ERROR = 0.002


def render_ours(program, scene, path, seed, samples):
    """Returns the picture and the warnings."""
    picture = path.with_suffix(".pfm")
    command = [program, "render", path, "-o", picture, "--samples", str(samples), "--filter", "box", "--seed", str(seed), "--threads", "1", "--restart"]
    done = subprocess.run(command + scene.options, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    warnings = re.findall(r"^warning(?:\[.*?\])?: (.*)", done.stderr, re.MULTILINE)
    return read_pfm(picture), warnings


def compare(program, number, folder):
    """Renders a scene with both programs. Returns its judgement, Dürer's warnings and the seconds."""
    scene, began = all_scenes()[number], time.time()
    path = folder / f"{scene.slug}.{scene.extension}"
    path.write_text(scene.text)
    ours, theirs, warnings, samples = [], [], [], scene.samples or SAMPLES
    judgement = None
    try:
        loaded = scene.load(mi, path)
        while judgement is None or (judgement.error > ERROR and len(ours) < MOST_RUNS):
            for _ in range(RUNS):
                seed = len(ours)
                picture, warnings = render_ours(program, scene, path, seed, samples)
                ours.append(picture)
                theirs.append(np.array(mi.render(loaded, spp=samples, seed=seed)).astype(float)[..., :3])
            judgement = Judgement(np.array(ours), np.array(theirs))
    except RuntimeError as error:
        return None, [str(error)], 0
    np.savez(path.with_suffix(".npz"), ours=ours, theirs=theirs)
    return judgement, warnings, time.time() - began


def all_scenes():
    # Scenes of Mitsuba's dictionaries need a variant. This one needs no compiler.
    mi.set_variant("scalar_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    return [*scenes(), *own.scenes()]


def workers(count):
    # Mitsuba's threads do not survive a fork.
    return concurrent.futures.ProcessPoolExecutor(count, mp_context=multiprocessing.get_context("spawn"))


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("program")
    arguments.add_argument("--only", default="", help="regular expression of kind and name")
    arguments.add_argument("--jobs", type=int, default=2)
    arguments.add_argument("--table", type=pathlib.Path)
    arguments.add_argument("--keep", type=pathlib.Path)
    given = arguments.parse_args()
    began = time.time()
    listed = list(enumerate(all_scenes()))
    chosen = [(number, scene) for number, scene in listed if re.search(given.only, f"{scene.kind}: {scene.name}")]
    with tempfile.TemporaryDirectory() as folder, workers(given.jobs) as pool:
        folder = given.keep or pathlib.Path(folder)
        folder.mkdir(exist_ok=True)
        assets.write(folder)
        verdicts = []
        waiting = [pool.submit(compare, given.program, number, folder) for number, _ in chosen]
        for (_, scene), future in zip(chosen, waiting):
            verdicts.append(Verdict(scene, *future.result()))
            print(verdicts[-1].line(), flush=True)
    text = Verdict.table(verdicts, mi.__version__)
    print(text)
    print(f"{(time.time() - began) / 60:.1f} minutes, {given.jobs} at a time")
    if given.table:
        given.table.write_text(text)
    raise SystemExit(0 if all(verdict.expected for verdict in verdicts) else 1)


if __name__ == "__main__":
    main()
