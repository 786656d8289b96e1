"""Scenes from files or built in code, and their rendered images and explanations."""

from __future__ import annotations

import asyncio
import json
import os
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, AsyncIterator, Callable, Iterable, Mapping, Optional, Sequence, TypeAlias, Union

import numpy as np
import numpy.typing as npt

from . import _durer
from ._arrays import Bools, Doubles, Floats, Ints, as_vectors
from ._errors import SceneError, with_python_names
from ._options import OPTIONS, Pairs, is_reading, is_work, pairs, parse_words
from ._progress import Progress, watch
from .rays import Mesh, check_rays, check_threads
from .things import Camera, Group, Light, Object, Thing, Writer, ply
from .words import Background, PhongMaterial

PathLike: TypeAlias = Union[str, "os.PathLike[str]"]

#: Images of single numbers, whose three channels are equal.
_SCALAR_IMAGES = {"depth", "object", "material", "sample-count", "variance", "cost"}


class Pictures(dict[str, Floats]):
    """Rendered images by name, as float32 arrays with the top row first. `color` is linear light of
    shape (height, width, 3). `alpha` is the fraction of each pixel that the camera covers, and
    exists unless it is 1 everywhere. Images of single numbers, such as depth, have the shape
    (height, width)."""

    def __init__(self, part: Part) -> None:
        super().__init__()
        #: The part that contains the images.
        self.part = part
        self._alpha: dict[str, Optional[npt.NDArray[np.float32]]] = {}
        for name, width, height, values, alpha in part._part.pictures(False):
            picture = values.reshape(height, width, 3)
            self[name] = picture[..., 0].copy() if name in _SCALAR_IMAGES else picture
            self._alpha[name] = alpha
            if alpha is not None and "alpha" not in self:
                self["alpha"] = alpha.reshape(height, width)

    def __reduce__(self) -> Any:
        return Pictures, (self.part,)

    @property
    def hash(self) -> str:
        """Hash of the film, as `durer render --hash` prints it for the same job."""
        return self.part.hash

    def file(self, name: str, transfer: str = "srgb") -> bytes:
        """Returns the bytes of an image file. The extension of `name` selects the format. `.exr`
        files contain all images; other files contain the first, as display values in eight-bit
        formats."""
        eight = Path(name).suffix.lower() in (".png", ".tga", ".bmp", ".ppm")
        layers = []
        for layer, width, height, values, alpha in self.part._part.pictures(eight):
            color = layer == "color"
            layers.append((layer, values.reshape(height, width, 3), None if alpha is None else alpha.tolist(), color))
        return _durer.encode(name, layers if name.lower().endswith(".exr") else layers[:1], transfer)

    def save(self, path: PathLike, transfer: str = "srgb") -> None:
        """Writes the images to a file: png, tga, bmp, ppm, pfm, hdr or exr."""
        _write(Path(path), self.file(os.fspath(path), transfer))

    def _repr_png_(self) -> bytes:
        return self.file("picture.png")

    def __repr__(self) -> str:
        return f"<Pictures: {', '.join(f'{name} {picture.shape}' for name, picture in self.items())}>"


def _write(path: Path, content: bytes) -> None:
    """Writes a file atomically."""
    beside = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        beside.write_bytes(content)
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)


class Part:
    """Partial render: the film of a shard, of an unfinished render, or of a finished image, which
    can be saved, continued and merged."""

    def __init__(self, part: _durer.Part) -> None:
        self._part = part
        #: The options with which the part was created, if known.
        self._options: Optional[dict[str, Any]] = None

    def __reduce__(self) -> Any:
        return Part.read, (self.bytes(),)

    @classmethod
    def read(cls, source: Union[PathLike, bytes]) -> Part:
        """Reads a part from a file or its bytes. Raises RenderError if it is damaged or was written
        by another version."""
        return cls(_durer.Part.read(source if isinstance(source, bytes) else Path(source).read_bytes()))

    @classmethod
    def merge(cls, parts: Iterable[Union[Part, PathLike, bytes]]) -> Part:
        """Merges parts. The result has the same bits as a single run. Raises RenderError if parts
        belong to different images or overlap, or if a part is missing."""
        named = []
        for i, part in enumerate(parts, 1):
            if isinstance(part, Part):
                named.append((f"part {i}", part.bytes()))
            elif isinstance(part, bytes):
                named.append((f"part {i}", part))
            else:
                named.append((os.fspath(part), Path(part).read_bytes()))
        return cls(_durer.merge(named))

    def bytes(self) -> bytes:
        """Returns the part as the bytes of a `.part` file."""
        return self._part.write()

    def save(self, path: PathLike) -> None:
        """Writes the part to a file."""
        _write(Path(path), self.bytes())

    def pictures(self) -> Pictures:
        """Returns the images rendered so far. Pixels without samples are black."""
        return Pictures(self)

    @property
    def hash(self) -> str:
        """Hash of the film."""
        return self._part.hash()

    @property
    def identity(self) -> str:
        """Hash of everything that determines the image: scene, job and version."""
        return self._part.identity()

    @property
    def shard(self) -> str:
        """Index of the shard and number of shards, for example `3/16`."""
        return self._part.shard()

    @property
    def job(self) -> dict[str, Any]:
        """The render job: everything besides the scene that determines the image."""
        job: dict[str, Any] = json.loads(self._part.job())
        return job

    @property
    def is_finished(self) -> bool:
        """True if no work is left."""
        return self._part.is_finished()

    @property
    def statistics(self) -> dict[str, int]:
        """Counts of samples, rays, and samples rejected because they were not finite."""
        return dict(zip(("samples", "rays", "rejected"), self._part.statistics()))

    def __repr__(self) -> str:
        total, done = self._part.work()
        return f"<Part {self.shard}: {100 * done // max(total, 1)} %>"


@dataclass(frozen=True, eq=False)
class Surfaces:
    """First hits of rays with the objects of a world. All arrays have the shape of the rays,
    followed by the components of vectors."""

    #: Distance along the ray, in units of the length of its direction; infinite for misses.
    t: Floats
    #: Index of the object, as in the image `object`; -1 for misses.
    object: Ints
    #: Index of the triangle for a mesh, 0 for other objects; -1 for misses.
    triangle: Ints
    #: Index of the material; -1 for misses.
    material: Ints
    #: Hit point; NaN for misses.
    point: Floats
    #: Unit geometric normal, pointing outwards; NaN for misses.
    normal: Floats
    #: Unit shading normal, interpolated on smooth meshes; NaN for misses.
    shading_normal: Floats
    #: The point in double precision, and the offset from it at which secondary rays start.
    _place: Doubles

    def leave(self, directions: npt.ArrayLike) -> Doubles:
        """Returns origins for secondary rays in the given directions; see `Hits.leave`. On a solid
        with several parts, a point that is closer to an edge than its precision can get an origin
        on the other side of that edge."""
        ways = as_vectors("directions", directions)
        try:
            ways = np.broadcast_to(ways, self.point.shape)
        except ValueError:
            raise ValueError(f"directions must have the shape {self.point.shape}, but has {ways.shape}") from None
        normal = self.normal.astype(np.float64)
        behind = (normal * ways).sum(-1, keepdims=True) < 0
        off = self._place[..., 3:]
        starts: Doubles = self._place[..., :3] + np.where(behind, -off, off) * normal
        return starts

    @property
    def hit(self) -> Bools:
        """Mask of the rays that hit something."""
        return self.object >= 0

    def __repr__(self) -> str:
        return f"<Surfaces of {self.t.size} rays: {int(self.hit.sum())} hit something>"


class World:
    """Scene with camera, lights and materials, ready for rendering. `durer.load` reads one from a
    file; the constructor builds one in code.

    `objects` are shapes, meshes, groups and solids. If `lights` is None, the scene has only ambient
    light, like a file without lights.
    """

    def __init__(
        self,
        camera: Camera,
        objects: Iterable[Union[Object, Mesh]],
        lights: Optional[Iterable[Light]] = (),
        background: Optional[Background] = None,
        *,
        folder: PathLike = ".",
        **reading: Any,
    ) -> None:
        writer, plain = Writer(), PhongMaterial(diffuse_color=(0.8, 0.8, 0.8))
        group = Group(*objects)
        content = group.write(writer, plain)
        parts: list[str] = [camera.text()]
        parts += [] if background is None else [background.text()]
        parts += [] if lights is None else ["Lights {\n    " + "\n    ".join(light.text() for light in lights) + "\n}"]
        materials = [material.text(writer.numbers) for material in writer.order]
        parts += ["Materials {\n    " + "\n    ".join(materials) + "\n}", content]
        given = [(f"mesh{i}.ply", ply(mesh)) for i, mesh in enumerate(writer.meshes)]
        self._load(Path(folder) / "scene.txt", ("\n".join(parts) + "\n").encode(), given, {"dialect": "durer", **reading})

    def _load(
        self,
        path: Path,
        text: Optional[bytes],
        given: list[tuple[str, bytes]],
        reading: Mapping[str, Any],
        own: Pairs = [],
    ) -> None:
        self.path, self._text, self._given, self._reading = path, text, given, [*pairs(reading, True), *own]
        self._world = with_python_names(lambda: _durer.World(path, text, given, self._reading))

    @classmethod
    def load(cls, path: PathLike, *, words: Optional[Sequence[str]] = None, **reading: Any) -> World:
        """Reads any scene that the command reads. Options are those of `durer render` that affect
        reading: dialect, compat, strict, allow_outside, assets, memory, eye, target, fov, and for
        models up, view, studio, environment, view_file, camera, fit, at. `eye` and `target` are
        texts such as "0,1.5,-4". A model gets lights and a ground, which rays can hit, unless
        `studio` is False. A model is framed for `size`, so pass `size` here;
        it also applies to `render`. `words` are options as written after `durer render SCENE`;
        those about rendering apply to all renders of the world. Raises SceneError with file, line
        and column."""
        world = cls.__new__(cls)
        world._load(Path(path), None, [], reading, parse_words(words))
        return world

    @classmethod
    def from_text(
        cls, text: str, folder: PathLike = ".", *, files: Optional[Mapping[str, bytes]] = None, **reading: Any
    ) -> World:
        """Reads a scene from text in the scene language, as if it were a file in `folder`. `files`
        are the contents of meshes and images by the names with which the text refers to them; other
        files are read from the folder."""
        world = cls.__new__(cls)
        world._load(Path(folder) / "scene.txt", text.encode(), list((files or {}).items()), reading)
        return world

    def __reduce__(self) -> Any:
        return World._restore, (self.path, self._text, self._given, self._reading)

    @staticmethod
    def _restore(path: Path, text: Optional[bytes], given: list[tuple[str, bytes]], reading: Pairs) -> World:
        world = World.__new__(World)
        world._load(path, text, given, {}, reading)
        return world

    def rewritten(self, text: str) -> World:
        """Returns the world of another text, in the same folder, with the same meshes and
        options."""
        return World._restore(self.path, text.encode(), self._given, self._reading)

    @property
    def text(self) -> str:
        """The text of the scene."""
        return (self._text if self._text is not None else self.path.read_bytes()).decode(errors="replace")

    @property
    def files(self) -> dict[str, bytes]:
        """The files that `save` writes: the scene's text as `scene.txt`, and the meshes that were
        built in code."""
        text = self._text if self._text is not None else self.path.read_bytes()
        return {"scene.txt" if self._text is not None else self.path.name: text, **dict(self._given)}

    def save(self, folder: PathLike) -> Path:
        """Writes the scene's files into a folder, and returns the path of the scene, which the
        command renders to the same image."""
        Path(folder).mkdir(parents=True, exist_ok=True)
        for name, content in self.files.items():
            _write(Path(folder) / name, content)
        return Path(folder) / next(iter(self.files))

    @property
    def digest(self) -> str:
        """Hash of the scene and all its files."""
        return self._world.digest()

    @property
    def dialect(self) -> str:
        """Name of the scene's dialect of the scene language."""
        return self._world.dialect()

    @property
    def warnings(self) -> list[str]:
        """Warnings from reading the scene."""
        return self._world.warnings()

    @property
    def description(self) -> dict[str, Any]:
        """The scene as data, in the JSON form that `durer convert` writes."""
        scene: dict[str, Any] = json.loads(self._world.description())
        return scene

    def part(self, **options: Any) -> Part:
        """Returns an empty part with these render options; `shard=(3, 16)` makes it the third of
        sixteen shards."""
        given = self._all(options)
        part = Part(with_python_names(lambda: self._world.part(given)))
        part._options = {name: value for name, value in options.items() if not is_work(name)}
        return part

    def _all(self, options: Mapping[str, Any]) -> Pairs:
        given = pairs(options, False)
        size = any(name == "size" for name, _ in given)
        return [pair for pair in self._reading if not (size and pair[0] == "size")] + given

    def render(
        self,
        *,
        part: Optional[Part] = None,
        progress: Progress = None,
        callback: Optional[Callable[[Pictures], object]] = None,
        every: float = 1.0,
        **options: Any,
    ) -> Pictures:
        """Renders the scene. Options are those of `durer render`, with the same defaults and the
        same resulting bits: size, samples, show, bounces, crop, noise_threshold, time_limit,
        threads, shard and all others that `durer.options()` lists.

        `part` continues earlier work. `callback` is called with the images so far, every `every`
        seconds. Ctrl-C and exceptions in the callback stop the render; the part keeps the work done
        so far.
        """
        if part is not None and options:
            self._same(part, options)
        begun = part or self.part(**options)
        shown, last = watch(progress), time.monotonic()

        def look(done: int, total: int) -> None:
            nonlocal last
            if shown is not None:
                shown(done, total)
            if callback is not None and time.monotonic() - last >= every:
                callback(begun.pictures())
                last = time.monotonic()

        wanted = None if shown is None and callback is None else look
        self._world.render(begun._part, self._all(options), wanted)
        if shown is not None:
            shown(1, 1)
        return begun.pictures()

    def _same(self, part: Part, options: Mapping[str, Any]) -> None:
        """Raises an error if options would change the image that the part belongs to."""

        def differs(wanted: Mapping[str, Any]) -> bool:
            deciding = {name: value for name, value in wanted.items() if not is_work(name)}
            asked = self.part(**{**(part._options or {}), **deciding})
            return bool(deciding) and (asked.job != part.job or "shard" in deciding and asked.shard != part.shard)

        self.part(**options)
        if differs(options):
            alone = [name for name in options if part._options is not None and differs({name: options[name]})]
            given = ", ".join(alone or options)
            raise ValueError(f"the part belongs to a different image than the options {given} would give: omit options that determine the image")

    def denoised(self, pictures: Union[Part, Pictures], *, threads: Optional[int] = None) -> Floats:
        """Returns the colours of a part or of its pictures without their noise, as linear light of
        shape (height, width, 3). The denoiser is `--denoise=own` of the command: it is guided by the
        surface in each pixel, and blurs what mirrors and glass show."""
        part = pictures.part if isinstance(pictures, Pictures) else pictures
        _, width, height, _, _ = part._part.pictures(False)[0]
        values = self._world.denoised(part._part, check_threads(threads))
        return values.reshape(height, width, 3)

    async def progressive(self, *, every: float = 1.0, **options: Any) -> AsyncIterator[Pictures]:
        """Renders in a thread. Yields the images so far every `every` seconds, and finally the
        finished images."""
        part, stop = self.part(**options), False

        def look(done: int, total: int) -> None:
            if stop:
                raise InterruptedError

        work = asyncio.ensure_future(
            asyncio.to_thread(self._world.render, part._part, self._all(options), look)
        )
        try:
            while not (await asyncio.wait([work], timeout=every))[0]:
                yield part.pictures()
            work.result()
            yield part.pictures()
        finally:
            stop = True
            if not work.done():
                await asyncio.wait([work])

    def closest(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
        *,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Surfaces:
        """Returns the first hit of each ray with any object, including spheres and solids, as when
        rendering. Arguments are those of `Mesh.closest`."""
        shape, rays = check_rays(origins, directions, t_min, t_max)
        ids, values, places = self._world.closest(rays, check_threads(threads), watch(progress))
        whole, other, place = ids.reshape(-1, 3), values.reshape(-1, 10), places.reshape(*shape, 4)

        def one(column: npt.NDArray[Any]) -> Any:
            return np.ascontiguousarray(column).reshape(shape)

        def three(columns: Floats) -> Floats:
            return np.ascontiguousarray(columns).reshape(*shape, 3)

        object, triangle, material = (one(whole[:, i]) for i in range(3))
        point, normal, shading = (three(other[:, i : i + 3]) for i in (1, 4, 7))
        return Surfaces(one(other[:, 0]), object, triangle, material, point, normal, shading, place)

    def occluded(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
        *,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Bools:
        """Returns True for each ray that hits anything, including glass."""
        shape, rays = check_rays(origins, directions, t_min, t_max)
        return self._world.occluded(rays, check_threads(threads), watch(progress)).reshape(shape)

    def explain(self, x: int, y: int, **options: Any) -> dict[str, Any]:
        """Explains a pixel's colour as a tree of terms that sum to it; see docs/explain.md. Pass
        the options of the render."""
        for name, value in (("x", x), ("y", y)):
            if not isinstance(value, (int, np.integer)) or not 0 <= value < 1 << 32:
                raise ValueError(f"{name} must be a pixel coordinate, a whole number of 0 or more, but is {value!r}")
        given = self._all(options)
        answer: dict[str, Any] = json.loads(with_python_names(lambda: self._world.explain(given, (int(x), int(y)))))
        return answer

    def check(self, **options: Any) -> list[dict[str, Any]]:
        """Returns likely mistakes in the scene, causes before consequences, as `durer check --json`
        lists them."""
        given = self._all(options)
        found: list[dict[str, Any]] = json.loads(with_python_names(lambda: self._world.check(given)))
        return found

    def _repr_png_(self) -> bytes:
        return self.render(samples=4, progress=False)._repr_png_()

    def __repr__(self) -> str:
        return f"<World {self.path.name}, dialect {self.dialect}>"


def load(path: PathLike, *, words: Optional[Sequence[str]] = None, **reading: Any) -> World:
    """Reads any scene that the command reads: see `World.load`."""
    return World.load(path, words=words, **reading)


def check(path: PathLike, **options: Any) -> list[dict[str, Any]]:
    """Returns errors and likely mistakes of a scene file, even if it cannot be rendered, as
    `durer check --json` lists them."""
    reading = {name: options.pop(name) for name in list(options) if is_reading(name)}
    try:
        return World.load(path, **reading).check(**options)
    except SceneError as error:
        return error.findings


def options() -> dict[str, str]:
    """Returns the options of `World.render` with their help."""
    return {name.replace("-", "_"): info.help for name, info in OPTIONS.items() if info.group != "reading"}


def kinds() -> dict[str, str]:
    """Returns the images that `show` accepts besides `color`, with their descriptions."""
    return dict(_durer.Part.kinds())


__all__ = ["Part", "Pictures", "SceneError", "Surfaces", "Thing", "World", "check", "kinds", "load", "options"]
