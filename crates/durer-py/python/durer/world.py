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
from ._arrays import Bools, Doubles, Floats, Ints, as_points, as_vectors
from ._errors import SceneError, check_type, with_hints, with_python_names
from ._options import OPTIONS, Pairs, is_reading, is_work, pairs, parse_words
from ._progress import Progress, watch
from .rays import Mesh, check_rays, check_threads
from .things import Camera, Group, Light, Object, Thing, Writer, ply
from .words import Background, PhongMaterial

PathLike: TypeAlias = Union[str, "os.PathLike[str]"]

#: Images of single numbers, whose three channels are equal.
_SCALAR_IMAGES = {"depth", "object", "material", "sample-count", "variance", "cost"}

#: Name, width, height, values and coverage of an image, and true if it shows light, which is saved
#: with the exposure and the transfer function.
_Layer: TypeAlias = tuple[str, int, int, Floats, Optional[Floats], bool]


@with_hints
class Pictures(dict[str, Floats]):
    """Rendered images by name, as float32 arrays with the top row first. `color` is linear light of
    shape (height, width, 3). `alpha` is the fraction of each pixel that the camera covers, and
    exists unless it is 1 everywhere. Images of single numbers, such as depth, have the shape
    (height, width)."""

    def __init__(self, part: Part) -> None:
        super().__init__()
        #: The part that contains the images.
        self.part = part
        self._denoised: Optional[_Layer] = None
        self._alpha: dict[str, Optional[npt.NDArray[np.float32]]] = {}
        for name, width, height, values, alpha, _ in part._part.pictures(False):
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

    def file(
        self,
        name: str,
        transfer: str = "srgb",
        *,
        exposure: float = 0.0,
        tone: str = "none",
        bits: int = 8,
        layer: Optional[str] = None,
    ) -> bytes:
        """Returns the bytes of an image file. The extension of `name` selects the format. `.exr`
        files contain all images; other files contain the first. `layer` selects another one.

        The options affect formats with integer values. `exposure` is in stops, each of which
        doubles the brightness, `tone` is "none", "reinhard", "aces", "agx" or "khronos-neutral",
        `transfer` is "srgb", "linear" or "course", and `bits` is 8 or 16 (png and ppm).

        >>> world.render(size=(8, 8), samples=1).file("a.png", exposure=1, bits=16)[:4]
        b'\\x89PNG'
        """
        shown = shown_with(transfer, exposure, tone, bits)
        layers = self._encodable(name)
        if layer is not None:
            layers = [row for row in layers if row[0] == layer]
            if not layers:
                raise ValueError(f"there is no image {layer!r}; the images are {', '.join(self)}")
        return _durer.encode(name, layers if _holds_all(name) else layers[:1], shown)

    def _encodable(self, name: str) -> list[tuple[str, Floats, Optional[list[float]], bool]]:
        """Returns the name, values and coverage of each image, and true if it shows light, in the
        form that `_durer.encode` takes for a file of this name."""
        integers = Path(name).suffix.lower() not in (".pfm", ".hdr", ".exr")
        pictures = [*([] if self._denoised is None else [self._denoised]), *self.part._part.pictures(integers)]
        layers = []
        for own, width, height, values, alpha, light in pictures:
            layers.append((own, values.reshape(height, width, 3), None if alpha is None else alpha.tolist(), light))
        return layers

    def save(
        self, path: PathLike, transfer: str = "srgb", *, exposure: float = 0.0, tone: str = "none", bits: int = 8
    ) -> list[Path]:
        """Writes the images, and returns the paths of the files. The extension selects the format:
        png, jpg, webp, tga, bmp, ppm, pfm, hdr or exr. An `.exr` file contains all images. In other
        formats, several images are written to files such as `picture.color.png` and
        `picture.depth.png`.

        `exposure` is in stops, `tone` is "none", "reinhard", "aces", "agx" or "khronos-neutral",
        `transfer` is "srgb", "linear" or "course", and `bits` is 8 or 16 (png and ppm).

        >>> [path.name for path in world.render(show="color,depth", size=(8, 8)).save("ball.png")]
        ['ball.color.png', 'ball.depth.png']
        """
        path, shown = Path(path), shown_with(transfer, exposure, tone, bits)
        layers = self._encodable(path.name)
        if not _holds_all(path.name) and self._denoised is not None:
            # The denoised image takes the place of the noisy one.
            layers = [row for row in layers if row[0] != "color"]
        files = {path: layers}
        if not _holds_all(path.name) and len(layers) > 1:
            files = {path.with_suffix(f".{row[0]}{path.suffix}"): [row] for row in layers}
        for written, rows in files.items():
            write_atomically(written, _durer.encode(written.name, rows, shown))
        return list(files)

    @property
    def stats(self) -> dict[str, int]:
        """Numbers of `samples`, `rays`, and `rejected` samples, which were NaN or infinite.

        >>> world.render(size=(8, 8), samples=4).stats["samples"]
        256
        """
        samples, rays, rejected = self.part._part.statistics()
        return {"samples": samples, "rays": rays, "rejected": rejected}

    def _repr_png_(self) -> bytes:
        return self.file("picture.png")

    def __repr__(self) -> str:
        return f"<Pictures: {', '.join(f'{name} {picture.shape}' for name, picture in self.items())}>"


def shown_with(transfer: str, exposure: float, tone: str, bits: int) -> tuple[float, str, str, int]:
    """Returns how values are converted for formats with integer values, for `_durer.encode`."""
    if not np.isfinite(exposure):
        raise ValueError(f"exposure must be a number of stops, but is {exposure!r}")
    return 2.0**exposure, tone, transfer, bits


def _holds_all(name: str) -> bool:
    """Returns true if the format of a file can contain several images."""
    return name.lower().endswith(".exr")


def write_atomically(path: Path, content: bytes) -> None:
    """Writes a file atomically."""
    if not path.parent.is_dir():
        raise FileNotFoundError(f"cannot write `{path}`: the folder `{path.parent}` does not exist")
    beside = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        beside.write_bytes(content)
        os.replace(beside, path)
    except OSError as error:
        raise OSError(error.errno, error.strerror, os.fspath(path)) from None
    finally:
        beside.unlink(missing_ok=True)


@with_hints
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
        belong to different images or overlap, or if a part is missing.

        >>> parts = [world.part(size=(16, 16), samples=4, shard=(i, 2)) for i in (1, 2)]
        >>> whole = [world.render(part=part) for part in parts]
        >>> durer.Part.merge(parts).hash == world.render(size=(16, 16), samples=4).hash
        True
        """
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
        write_atomically(Path(path), self.bytes())

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
    followed by the components of vectors.

    t: distance along the ray, in units of the length of its direction; infinite for misses.
    Float32.

    object: index in the list of all objects in all groups, as in the image `object`; -1 for misses.
    Int32.

    triangle: index of the triangle for a mesh, 0 for other objects; -1 for misses. Int32.

    material: index of the material, as in the image `material`; -1 for misses. Int32.

    point: hit point; NaN for misses. Float32 of shape (..., 3). Use `leave` for origins of
    secondary rays.

    normal: unit geometric normal, pointing outwards; NaN for misses. Float32 of shape (..., 3).

    shading_normal: unit shading normal, interpolated on smooth meshes; NaN for misses. Float32 of
    shape (..., 3).
    """

    t: Floats
    object: Ints
    triangle: Ints
    material: Ints
    point: Floats
    normal: Floats
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


@with_hints
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
        check_type("camera", camera, Camera, "a camera such as PerspectiveCamera")
        check_type("objects", objects, Iterable, "a list of shapes, meshes, groups or solids")
        check_type("lights", lights, (Iterable, type(None)), "a list of lights, or None")
        check_type("background", background, (Background, type(None)), "a Background, or None")
        lights = None if lights is None else list(lights)
        for i, light in enumerate(lights or []):
            check_type(f"lights[{i}]", light, Light, "a light such as PointLight")
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
        texts such as "0,1.5,-4". `view` is "three-quarter", "front", "back", "left", "right" or
        "side" (the same), "top", "bottom", "iso", "iso-left" or "iso-back". A model gets lights and
        a ground, which rays can hit, unless `studio` is False. A model is framed for `size`, so
        pass `size` here; it also applies to `render`. `words` are options as written after `durer
        render SCENE`; those about rendering apply to all renders of the world. Raises SceneError
        with file, line and column."""
        world = cls.__new__(cls)
        world._load(Path(path), None, [], reading, parse_words(words))
        return world

    @classmethod
    def from_text(
        cls, text: str, folder: PathLike = ".", *, files: Optional[Mapping[str, bytes]] = None, **reading: Any
    ) -> World:
        """Reads a scene from text in the scene language, as if it were a file in `folder`. `files`
        are the contents of meshes and images by the names with which the text refers to them; other
        files are read from the folder.

        >>> text = "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 } Group { Sphere { center 0 0 0 radius 1 } }"
        >>> durer.World.from_text(text).closest((0, 0, 5), (0, 0, -1)).t
        array(4., dtype=float32)
        """
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
            write_atomically(Path(folder) / name, content)
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
        seconds. `progress` is a function that is called with the finished and the total number of
        samples (in images such as depth, of rays), every 0.05 seconds, and at the end with the
        total twice, also if `time_limit` or `noise_threshold` ended the render before. By default,
        a long render shows a progress line on a terminal; with False, it does not. Ctrl-C and
        exceptions in `callback` or `progress` stop the render; the part keeps the work done so far.

        >>> pictures = world.render(size=(40, 30), samples=4, show="color,depth")
        >>> pictures["color"].shape, pictures["depth"].shape
        ((30, 40, 3), (30, 40))
        """
        check_type("part", part, (Part, type(None)), "a Part, or None")
        if callback is not None and not callable(callback):
            raise TypeError(f"callback must be a function of the images, but is of type {type(callback).__name__}")
        shown, last = watch(progress), time.monotonic()
        if part is not None and options:
            self._same(part, options)
        begun = part or self.part(**options)
        total, _ = begun._part.work()

        def look(done: int, _: int) -> None:
            nonlocal last
            if shown is not None:
                shown(done, total)
            if callback is not None and time.monotonic() - last >= every:
                callback(begun.pictures())
                last = time.monotonic()

        wanted = None if shown is None and callback is None else look
        self._world.render(begun._part, self._all(options), wanted)
        if shown is not None:
            shown(total, total)
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

    def rays(self, **options: Any) -> tuple[Doubles, Doubles]:
        """Returns the origins and the directions of the camera rays through the centres of all
        pixels, as float64 arrays of shape (height, width, 3) with the top row first. Options are
        those of `render`, of which `size` and `crop` matter.

        These are the rays that images such as depth are made of. Directions have unit length.
        Where the camera has no ray, both are NaN, and such rays hit nothing. A lens is passed
        through its centre. Clipping planes of the camera are not part of the rays.

        >>> origins, directions = world.rays(size=(40, 30))
        >>> world.closest(origins, directions).t.shape
        (30, 40)
        """
        width, height, rays = self._world.rays(self.part(**options)._part)
        both = rays.reshape(height, width, 2, 3).astype(np.float64)
        return both[:, :, 0], both[:, :, 1]

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
        rendering. Arguments are those of `Mesh.closest`.

        >>> world.closest((0, 5, 0), (0, -1, 0))
        <Surfaces of 1 rays: 1 hit something>
        """
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
        """Returns True for each ray that hits anything, including glass.

        >>> world.occluded((0, 5, 0), (0, -1, 0))
        array(True)
        """
        shape, rays = check_rays(origins, directions, t_min, t_max)
        return self._world.occluded(rays, check_threads(threads), watch(progress)).reshape(shape)

    def denoise(self, pictures: Union[Part, Pictures], *, threads: Optional[int] = None) -> Pictures:
        """Returns the images of a part or of its pictures with the denoised colour first, as
        `denoised`, of shape (height, width, 3). The denoiser is the built-in one of `durer render
        --denoise=own`: a non-local-means filter guided by albedo, normals and positions.

        >>> noisy = world.render(size=(40, 30), samples=4)
        >>> world.denoise(noisy)["denoised"].shape
        (30, 40, 3)
        """
        check_type("pictures", pictures, (Part, Pictures), "the result of render, or a Part")
        part = pictures.part if isinstance(pictures, Pictures) else pictures
        result = Pictures(part)
        result._denoised = part._part.denoised(self._world, check_threads(threads))
        name, width, height, values, *_ = result._denoised
        result[name] = values.reshape(height, width, 3)
        return result

    def measure(
        self,
        points: npt.ArrayLike,
        normals: npt.ArrayLike = (0.0, 1.0, 0.0),
        *,
        kind: str = "planar",
        samples: Optional[int] = None,
        error: Optional[float] = None,
        progress: Progress = None,
        **options: Any,
    ) -> Illuminance:
        """Measures the light that arrives at points, of shape (..., 3), on the side of `normals`,
        by path tracing, with the values of `durer measure`. `kind` is `planar`, `cylindrical` (the
        mean illuminance of all planes through the normal) or `spherical`.

        `samples` is the number of samples of each point [default: 4096]. With `error`, for example
        0.01, a point needs no more samples once its relative standard error is that small, and
        `samples` is the maximum [default: 1048576]. Other options are those of `render`, such as
        bounces and seed. A model's own light is measured only if it was loaded with `studio=False`.
        `progress` is as for `Mesh.closest`.

        >>> light = world.measure((0, 1.2, 0), normals=(0, 1, 0), samples=64)
        >>> light.illuminance.shape, bool(light.illuminance > 0)
        ((), True)
        """
        at = np.asarray(as_points("points", points), np.float32)
        shape = at.shape[:-1]
        towards = np.broadcast_to(np.asarray(as_vectors("normals", normals, 3), np.float64), (*shape, 3))
        lengths = np.linalg.norm(towards, axis=-1, keepdims=True)
        if not (np.isfinite(at).all() and np.isfinite(lengths).all() and (lengths > 0).all()):
            raise ValueError("points must be finite, and normals finite and not zero")
        if error is not None and not 0 < error <= 1:
            raise ValueError(f"error must be a share from 0 to 1, but is {error!r}")
        if samples is not None and (not isinstance(samples, (int, np.integer)) or not 2 <= samples <= 1 << 24):
            raise ValueError(f"samples must be a whole number from 2 to {1 << 24}, but is {samples!r}")
        given = self._all({"integrator": "path", **options})
        rows = np.ascontiguousarray(at.reshape(-1, 3)), np.ascontiguousarray(towards / lengths, np.float32).reshape(-1, 3)
        shown, total = watch(progress), len(rows[0])
        look = None if shown is None else lambda done, steps: shown(total * done // steps, total)
        found = with_python_names(lambda: _durer.measure(self._world, rows, kind, (samples, error), given, look))
        if shown is not None:
            shown(total, total)
        irradiance, lux, deviation, count, rare = found
        return Illuminance(
            lux.reshape(shape), deviation.reshape(shape), irradiance.reshape(*shape, 3), count.reshape(shape), rare
        )

    def explain(self, x: int, y: int, **options: Any) -> dict[str, Any]:
        """Explains a pixel's colour as a tree of terms that sum to it; see docs/explain.md. Pass
        the options of the render.

        >>> found = world.explain(20, 15, size=(40, 30), samples=1)
        >>> sorted(found)
        ['lights', 'materials', 'objects', 'pixel', 'version']
        """
        for name, value in (("x", x), ("y", y)):
            if not isinstance(value, (int, np.integer)) or not 0 <= value < 1 << 32:
                raise ValueError(f"{name} must be a pixel coordinate, a whole number of 0 or more, but is {value!r}")
        given = self._all(options)
        answer: dict[str, Any] = json.loads(with_python_names(lambda: self._world.explain(given, (int(x), int(y)))))
        return answer

    def check(self, **options: Any) -> list[dict[str, Any]]:
        """Returns likely mistakes in the scene, causes before consequences, as `durer check --json`
        lists them.

        >>> world.check()
        []
        """
        given = self._all(options)
        found: list[dict[str, Any]] = json.loads(with_python_names(lambda: self._world.check(given)))
        return found

    def _repr_png_(self) -> bytes:
        return self.render(samples=4, progress=False)._repr_png_()

    def __repr__(self) -> str:
        return f"<World {self.path.name}, dialect {self.dialect}>"


@dataclass(frozen=True)
class Illuminance:
    """Light at the points that `World.measure` was given. All arrays have the shape of the points
    without its last axis, followed by the channels of the irradiance.

    illuminance: illuminance, 0 or more: in lux if the light of the scene has units, otherwise in
    the unit of the scene. Float64.

    error: standard error of the illuminance, in the unit of the illuminance, so `error /
    illuminance` is the relative error that the argument `error` of `measure` limits. It assumes
    independent samples and is rather too large. Float64.

    irradiance: irradiance of the three channels: in W/m^2 in Radiance scenes, otherwise in the unit
    of the illuminance. Float64 of shape (..., 3).

    samples: number of samples of each point. Uint32.

    has_rare_light: true if the error of a point is mostly that of lights that only random paths
    find: those in mirrors or glass, on solids, or textured. Then use more samples or
    `integrator="photons"`.
    """

    illuminance: Doubles
    error: Doubles
    irradiance: Doubles
    samples: npt.NDArray[np.uint32]
    has_rare_light: bool

    @property
    def uniformity(self) -> float:
        """U0: the minimum divided by the average; 0 in the dark."""
        average = float(self.illuminance.mean())
        return float(self.illuminance.min()) / average if average > 0 else 0.0


def load(path: PathLike, *, words: Optional[Sequence[str]] = None, **reading: Any) -> World:
    """Reads any scene that the command reads: see `World.load`.

    >>> durer.load("scenes/whitted.txt")
    <World whitted.txt, dialect durer>
    """
    return World.load(path, words=words, **reading)


def check(path: PathLike, **options: Any) -> list[dict[str, Any]]:
    """Returns errors and likely mistakes of a scene file, even if it cannot be rendered, as
    `durer check --json` lists them.

    >>> durer.check("scenes/whitted.txt")
    []
    """
    reading = {name: options.pop(name) for name in list(options) if is_reading(name)}
    try:
        return World.load(path, **reading).check(**options)
    except SceneError as error:
        return error.findings


def options() -> dict[str, str]:
    """Returns the options of `World.render` with their help.

    >>> "samples" in durer.options()
    True
    """
    return {name.replace("-", "_"): info.help for name, info in OPTIONS.items() if info.group != "reading"}


def kinds() -> dict[str, str]:
    """Returns the images that `show` accepts besides `color`, with their descriptions.

    >>> "normals" in durer.kinds()
    True
    """
    return dict(_durer.Part.kinds())


__all__ = ["Illuminance", "Part", "Pictures", "SceneError", "Surfaces", "Thing", "World", "check", "kinds", "load", "options"]
