"""Pictures on a Dask cluster: shards as tasks, merged bit for bit to what one machine would have made."""

from __future__ import annotations

import functools
import tempfile
import uuid
import warnings
from collections import deque
from pathlib import Path
from typing import Any, Iterable, Iterator, Optional, Sequence, Union

from . import _durer
from ._options import Pairs, parsed
from ._progress import Progress, watch
from .world import Part, PathLike, Pictures, World, load


def _files(world: World) -> dict[str, bytes]:
    """All files of a scene, by their names below its folder; the scene's own first."""
    files, folder = world.files, world.path.parent.resolve()
    for source in world._world.sources():
        path = Path(source).resolve()
        if path == world.path.resolve() or not path.is_file():
            continue
        if not path.is_relative_to(folder):
            raise ValueError(f"{path} lies outside the scene's folder, and is not sent to a farm")
        files.setdefault(str(path.relative_to(folder)), path.read_bytes())
    return files


@functools.lru_cache(maxsize=4)
def _opened(files: tuple[tuple[str, bytes], ...], reading: tuple[tuple[str, str], ...]) -> _durer.World:
    """A scene from its files: opened once in each worker."""
    with tempfile.TemporaryDirectory() as folder:
        for name, content in files:
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        return _durer.World(Path(folder) / files[0][0], None, [], list(reading))


def shard(files: tuple[tuple[str, bytes], ...], reading: tuple[tuple[str, str], ...], options: Pairs, index: int, count: int) -> bytes:
    """One shard, as the bytes of a part: what workers do."""
    world = _opened(files, reading)
    own = [*options, ("threads", "1"), ("shard", f"{index}/{count}")]
    part = world.part(own)
    world.render(part, own, None)
    return part.write()


def _whole(names: Sequence[str], contents: Sequence[bytes], reading: tuple[tuple[str, str], ...], options: Pairs, index: int, count: int) -> bytes:
    """The same of files whose contents were sent one by one."""
    return shard(tuple(zip(names, contents)), reading, options, index, count)


def _given(content: bytes) -> bytes:
    """A file, as a task."""
    return content


class _Frame:
    """A picture whose shards are with the workers."""

    def __init__(
        self, world: World, client: Any, shards: int, asked: Pairs, sent: dict[bytes, Any]
    ) -> None:
        # What is wrong with the options is better known before anything is sent.
        world._world.part([*asked, ("shard", f"1/{shards}")])
        files = _files(world)
        # Files are tasks that give them, not scattered data: of these Dask keeps one copy, and it is lost with the worker that has it.
        # They are held until the end: who dies with shards that were done already leaves them to others, who need the files.
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Sending large graph")
            for content in files.values():
                if content not in sent:
                    sent[content] = client.submit(_given, content, key=f"durer-file-{uuid.uuid4().hex}")
        self.contents = contents = [sent[content] for content in files.values()]
        # Names are this run's own: what an earlier one, of other shards perhaps, has under way or is about to forget is none of it.
        name = f"durer-{world.digest[:12]}-{uuid.uuid4().hex[:12]}"
        self.client = client
        self.futures = [
            client.submit(
                _whole, list(files), contents, tuple(world._reading), asked, index, shards, key=(name, index)
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
    """Renders a scene with the workers of a `distributed.Client`, and merges: the same bits and hash as one machine.

    The scene's files are sent once to each worker. A worker that dies costs its shards only, which others make again; workers that come
    meanwhile take part. Options are those of `World.render`, or `words` as on the command line, for a scene's file those of reading it
    too. A worker with another version of durer is refused by the merge.
    """
    from distributed import as_completed

    if isinstance(scene, World):
        world, asked = scene, [*scene._all(options), *parsed(words)]
    else:
        world = load(scene, words=words)
        asked = world._all(options)
    frame = _Frame(world, client, shards, asked, {})
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
    """Renders scenes one after the other, as the frames of an animation whose camera or things move, and gives their pictures in
    order. Each is made in shards as `render` makes it; up to `ahead` of them are under way at once, and files that frames have in
    common are sent once."""
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
