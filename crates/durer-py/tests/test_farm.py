"""Tests of farms: Dask with workers that are killed, and the templates of `durer farm`."""

import os
import random
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from test_worlds import command

import durer

JOB = {"size": (160, 120), "samples": 16}
WORDS = ["--size", "160x120", "--samples", "16"]


@pytest.mark.parametrize(("killed", "after"), [(0, 0), (2, 3), (1, 63)])
def test_dask_result_survives_dead_workers(scenes, killed, after):
    distributed = pytest.importorskip("distributed")
    import durer.farm

    wanted = durer.load(scenes / "whitted.txt").render(**JOB).hash
    cluster = distributed.LocalCluster(n_workers=4, threads_per_worker=1, dashboard_address=None)
    with cluster, distributed.Client(cluster) as client:
        left, random_ = killed, random.Random(killed)

        def watch(done, total):
            nonlocal left
            if left and done > after:
                left -= 1
                # Kill each worker only once: Dask removes dead workers in the meantime.
                workers = [w.process.process for w in cluster.workers.values() if w.process]
                random_.choice([process for process in workers if process and process.is_alive()]).kill()

        pictures = durer.farm.render(scenes / "whitted.txt", client=client, shards=64, progress=watch, **JOB)
        assert pictures.hash == wanted and left == 0


def test_frames_come_in_order_with_the_bits_of_one_machine():
    distributed = pytest.importorskip("distributed")
    import durer.farm

    things = durer.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])

    def frame(i):
        camera = durer.PerspectiveCamera(center=(i - 1, 1, 5), direction=(0.1 - 0.1 * i, -0.1, -1), up=(0, 1, 0), angle=30)
        return durer.World(camera, [durer.Model(things)], [durer.DirectionalLight(direction=(-1, -2, -1), color=(1, 1, 1))])

    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, processes=False)
    with cluster, distributed.Client(cluster) as client:
        found = [p.hash for p in durer.farm.frames(map(frame, range(5)), client=client, ahead=2, size=(40, 30), samples=4)]
    assert found == [frame(i).render(size=(40, 30), samples=4).hash for i in range(5)] and len(set(found)) == 5


def test_consecutive_runs_are_independent(scenes):
    distributed = pytest.importorskip("distributed")
    import durer.farm

    job = {"size": (48, 32), "samples": 4}
    wanted = durer.load(scenes / "whitted.txt").render(**job).hash
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with cluster, distributed.Client(cluster) as client:
        for shards in (12, 7, 12, 12, 5):
            assert durer.farm.render(scenes / "whitted.txt", client=client, shards=shards, **job).hash == wanted


@pytest.mark.parametrize("engine", ["slurm", "k8s", "openjd", "dask"])
def test_templates_are_complete(engine, scenes):
    done = command("farm", scenes / "whitted.txt", "--template", engine, "--shards", 3, *WORDS)
    assert done.returncode == 0 and "@" not in done.stdout.replace("@%", ""), done.stderr
    if engine == "slurm":
        assert subprocess.run(["bash", "-n"], input=done.stdout, text=True).returncode == 0
    if engine == "dask":
        compile(done.stdout, "render.py", "exec")
    if engine in ("k8s", "openjd"):
        pytest.importorskip("yaml").safe_load(done.stdout)


def program(folder):
    """Creates a `durer` command in a folder, for templates that call it, and returns an environment
    that finds it."""
    (folder / "bin").mkdir()
    there = folder / "bin/durer"
    there.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m durer "$@"\n')
    there.chmod(0o755)
    return {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}


WALK = """PerspectiveCamera {{ center {0} 0 5 direction 0 0 -1 up 0 1 0 angle 40 }}
Lights {{ DirectionalLight {{ direction 0 0 -1 color 1 1 1 }} }}
Materials {{ PhongMaterial {{ diffuseColor 0.2 0.4 0.8 }} }}
Group {{ MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }} }}
"""


@pytest.mark.parametrize("engine", ["slurm", "k8s", "openjd", "dask"])
def test_frames_equal_command_output(engine, tmp_path):
    """Runs the jobs of the templates as their engines would: each task with its index, then the
    merge."""
    for frame in (3, 5, 7):
        (tmp_path / f"walk.{frame:02}.txt").write_text(WALK.format((frame - 5) / 4))
    words = ["--size", "48x32", "--samples", "4"]
    job = command("farm", "walk.%02d.txt", "--template", engine, "--frames", "3-7:2", "--shards", "2", *words, cwd=tmp_path)
    assert job.returncode == 0, job.stderr
    environment = program(tmp_path)

    def run(*words, **more):
        done = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, env={**environment, **more})
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    if engine == "slurm":
        for task in range(1, 7):
            run("bash", "-c", job.stdout, SLURM_ARRAY_TASK_ID=str(task))
    if engine == "k8s":
        (container,) = pytest.importorskip("yaml").safe_load(job.stdout)["spec"]["template"]["spec"]["containers"]
        for task in range(6):
            run(*container["command"], *container["args"], JOB_COMPLETION_INDEX=str(task))
    if engine in ("slurm", "k8s"):
        # The commands for merging are in the template's comment.
        merge = [line.removeprefix("#") for line in job.stdout.splitlines() if line.startswith("#   ")]
        assert len(merge) == 3
        run("bash", "-c", "\n".join(merge))
    if engine == "openjd":
        openjd = Path(sys.executable).with_name("openjd")
        if not openjd.exists():
            pytest.skip("openjd is not installed")
        (tmp_path / "job.yaml").write_text(job.stdout)
        run(openjd, "check", "job.yaml")
        run(openjd, "run", "job.yaml", "-p", f"Folder={tmp_path}")
    if engine == "dask":
        pytest.importorskip("distributed")
        (tmp_path / "job.py").write_text(job.stdout)
        run(sys.executable, "job.py")
    for frame in (3, 5, 7):
        run("durer", "render", f"walk.{frame:02}.txt", "-o", "whole.exr", *words)
        whole, made = (durer.read(tmp_path / name)[0] for name in ("whole.exr", f"walk.{frame:02}.exr"))
        assert (whole == made).all() and whole.shape == (32, 48, 3)


def test_wrong_options_make_no_template(scenes):
    done = command("farm", scenes / "whitted.txt", "--template", "slurm", "--samples", 0)
    assert done.returncode == 2 and "samples" in done.stderr and not done.stdout


def test_openjd_checks_and_runs(scenes, tmp_path):
    openjd = Path(sys.executable).with_name("openjd")
    if not openjd.exists():
        pytest.skip("openjd is not installed")
    shutil.copytree(scenes, tmp_path / "work")
    job = command("farm", "whitted.txt", "--template", "openjd", "--shards", 3, "-o", "a.exr", *WORDS, cwd=tmp_path / "work")
    (tmp_path / "job.yaml").write_text(job.stdout)
    environment = program(tmp_path)
    checked = subprocess.run([openjd, "check", tmp_path / "job.yaml"], capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr
    words = [openjd, "run", tmp_path / "job.yaml", "-p", f"Folder={tmp_path / 'work'}"]
    done = subprocess.run(words, capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr
    assert durer.load(scenes / "whitted.txt").render(**JOB).hash in done.stdout
