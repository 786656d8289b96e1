"""Farms: Dask with workers that are killed, and the templates of `durer farm`."""

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
def test_dask_makes_the_same_bits_whoever_dies(scenes, killed, after):
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
                workers = [w.process.process for w in cluster.workers.values() if w.process and w.process.process.is_alive()]
                random_.choice(workers).kill()

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


def test_runs_one_after_the_other_have_nothing_to_do_with_each_other(scenes):
    distributed = pytest.importorskip("distributed")
    import durer.farm

    job = {"size": (48, 32), "samples": 4}
    wanted = durer.load(scenes / "whitted.txt").render(**job).hash
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with cluster, distributed.Client(cluster) as client:
        for shards in (12, 7, 12, 12, 5):
            assert durer.farm.render(scenes / "whitted.txt", client=client, shards=shards, **job).hash == wanted


@pytest.mark.parametrize("engine", ["slurm", "k8s", "openjd", "dask"])
def test_templates_are_whole(engine, scenes):
    done = command("farm", scenes / "whitted.txt", "--template", engine, "--shards", 3, *WORDS)
    assert done.returncode == 0 and "@" not in done.stdout.replace("@%", ""), done.stderr
    if engine == "slurm":
        assert subprocess.run(["bash", "-n"], input=done.stdout, text=True).returncode == 0
    if engine == "dask":
        compile(done.stdout, "render.py", "exec")
    if engine in ("k8s", "openjd"):
        pytest.importorskip("yaml").safe_load(done.stdout)


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
    (tmp_path / "bin").mkdir()
    program = tmp_path / "bin/durer"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m durer "$@"\n')
    program.chmod(0o755)
    import os

    environment = {**os.environ, "PATH": f"{tmp_path / 'bin'}:{os.environ['PATH']}"}
    checked = subprocess.run([openjd, "check", tmp_path / "job.yaml"], capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr
    words = [openjd, "run", tmp_path / "job.yaml", "-p", f"Folder={tmp_path / 'work'}"]
    done = subprocess.run(words, capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr
    assert durer.load(scenes / "whitted.txt").render(**JOB).hash in done.stdout
