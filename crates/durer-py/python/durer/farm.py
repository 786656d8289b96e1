"""Renders on a Dask cluster. Shards are tasks, and the merged image has the same bits as on one
machine."""

from __future__ import annotations

import functools
import tempfile
import uuid
import warnings
from collections import deque
from pathlib import Path
from typing import Any, Iterable, Iterator, Optional, Sequence, Union

from . import _durer
from ._options import Pairs, parse_words
from ._progress import Progress, watch
from .world import Part, PathLike, Pictures, World, load


def _files(world: World) -> dict[str, bytes]:
    """Returns the contents of a scene's files by their names relative to its folder. The scene file
    is the first."""
    files, folder = world.files, world.path.parent.resolve()
    for source in world._world.sources():
        path = Path(source).resolve()
        if path == world.path.resolve() or not path.is_file():
            continue
        if not path.is_relative_to(folder):
            raise ValueError(f"{path} is outside the scene's folder and cannot be sent to a farm")
        files.setdefault(str(path.relative_to(folder)), path.read_bytes())
    return files


@functools.lru_cache(maxsize=4)
def _load(files: tuple[tuple[str, bytes], ...], reading: tuple[tuple[str, str], ...]) -> _durer.World:
    """Loads a scene from its files. The cache makes each worker load it once."""
    with tempfile.TemporaryDirectory() as folder:
        for name, content in files:
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        return _durer.World(Path(folder) / files[0][0], None, [], list(reading))


def shard(files: tuple[tuple[str, bytes], ...], reading: tuple[tuple[str, str], ...], options: Pairs, index: int, count: int) -> bytes:
    """Renders one shard in a worker, and returns its part as bytes."""
    world = _load(files, reading)
    own = [*options, ("threads", "1"), ("shard", f"{index}/{count}")]
    part = world.part(own)
    world.render(part, own, None)
    return part.write()


def _shard_task(names: Sequence[str], contents: Sequence[bytes], reading: tuple[tuple[str, str], ...], options: Pairs, index: int, count: int) -> bytes:
    """Renders one shard, with the contents of each file as a separate argument, so that Dask sends
    each file once."""
    return shard(tuple(zip(names, contents)), reading, options, index, count)


def _file_task(content: bytes) -> bytes:
    """Returns `content`: the task that holds a file's contents on the cluster."""
    return content


class _Frame:
    """An image whose shards are being rendered by the workers."""

    def __init__(
        self, world: World, client: Any, shards: int, pairs: Pairs, sent: dict[bytes, Any]
    ) -> None:
        # Report wrong options before anything is sent.
        world._world.part([*pairs, ("shard", f"1/{shards}")])
        files = _files(world)
        # Each file is a task that returns its contents, which Dask can run again. Scattered data
        # would be lost with the worker that has the only copy. The tasks are held until the end,
        # because shards that are lost with a worker must be rendered again.
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Sending large graph")
            for content in files.values():
                if content not in sent:
                    sent[content] = client.submit(_file_task, content, key=f"durer-file-{uuid.uuid4().hex}")
        self.contents = contents = [sent[content] for content in files.values()]
        # Task names are unique to this run, so that tasks of earlier runs do not interfere.
        name = f"durer-{world.digest[:12]}-{uuid.uuid4().hex[:12]}"
        self.client = client
        self.futures = [
            client.submit(
                _shard_task, list(files), contents, tuple(world._reading), pairs, index, shards, key=(name, index)
            )
            for index in range(1, shards + 1)
        ]

    def pictures(self) -> Pictures:
        """Waits for all shards, and merges them."""
        parts = self.client.gather(self.futures)
        return Pictures(Part(_durer.merge([(f"shard {index}", content) for index, content in enumerate(parts, 1)])))

    def cancel(self) -> None:
        self.client.cancel([future for future in self.futures if not future.done()])


def render(
    scene: Union[World, PathLike],
    *,
    client: Any,
    shards: int = 64,
    words: Optional[Sequence[str]] = None,
    progress: Progress = None,
    **options: Any,
) -> Pictures:
    """Renders a scene on the workers of a `distributed.Client`, and merges the shards. The image
    has the same bits and hash as on one machine.

    The scene's files are sent once to each worker. If a worker dies, other workers render its
    shards again. Workers can join during the render. Options are those of `World.render`, or
    `words` as on the command line. If `scene` is a path, options about reading are accepted too.
    The merge refuses results of workers with a different version of durer.
    """
    from distributed import as_completed

    if isinstance(scene, World):
        world, pairs = scene, [*scene._all(options), *parse_words(words)]
    else:
        world = load(scene, words=words)
        pairs = world._all(options)
    frame = _Frame(world, client, shards, pairs, {})
    shown = watch(progress)
    try:
        for done, _ in enumerate(as_completed(frame.futures), 1):  # type: ignore[no-untyped-call, unused-ignore]
            if shown is not None:
                shown(done, shards)
        return frame.pictures()
    finally:
        frame.cancel()


def frames(
    scenes: Iterable[Union[World, PathLike]], *, client: Any, shards: int = 4, ahead: int = 8, **options: Any
) -> Iterator[Pictures]:
    """Renders a sequence of scenes, such as the frames of an animation, and yields their images in
    order. Each is rendered in shards, like `render`. Up to `ahead` frames are in progress at once,
    and files shared between frames are sent once."""
    waiting: deque[_Frame] = deque()
    sent: dict[bytes, Any] = {}
    try:
        for scene in scenes:
            world = scene if isinstance(scene, World) else load(scene)
            waiting.append(_Frame(world, client, shards, world._all(options), sent))
            if len(waiting) >= ahead:
                yield waiting.popleft().pictures()
        while waiting:
            yield waiting.popleft().pictures()
    finally:
        for frame in waiting:
            frame.cancel()
