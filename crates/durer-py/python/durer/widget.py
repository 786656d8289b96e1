"""A scene in a notebook: drag to orbit, click a pixel to see why it has its colour.

    from durer.widget import Explorer

    Explorer(durer.load("scene.txt"))

It needs anywidget: `pip install durer[notebook]`.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Optional

import anywidget
import numpy as np
import numpy.typing as npt
import traitlets

from .world import World

_Vector = npt.NDArray[np.float64]

#: A camera's block in the scene language; no such block nests braces more than once. Comments match
#: first, so that cameras in them do not count.
_CAMERA = re.compile(r"#[^\n]*|\b([A-Za-z]+Camera)\s*\{((?:[^{}#]|#[^\n]*|\{[^{}]*\})*)\}")
#: A field of three numbers.
_FIELD = r"\b{}((?:\s+[-+.\deE]+){{3}})"
#: Limit of the elevation from the poles, in degrees.
_STEEPEST = 3.0


class _Camera:
    """The camera of a scene in the scene language, and its target."""

    def __init__(self, world: World) -> None:
        blocks = [found for found in _CAMERA.finditer(world.text) if found[1]]
        if len(blocks) != 1:
            raise ValueError(f"{world.path.name} has no camera in the scene language that could go around it")
        self.text, (self.start, self.end) = world.text, blocks[0].span()
        self.block = blocks[0][0]
        self.eye, self.along, self.up = (self._field(name) for name in ("center", "direction", "up"))
        hit = world.closest(self.eye, self.along, progress=False)
        met = float(hit.t) * float(np.linalg.norm(self.along))
        # If it looks at nothing, orbit at the origin's distance.
        self.far = met if np.isfinite(met) and met > 0 else max(float(np.linalg.norm(self.eye)), 1.0)
        self.target = self.eye + self.far * _unit(self.along)

    def _field(self, name: str) -> _Vector:
        found = re.search(_FIELD.format(name), self.block)
        if found is None:
            raise ValueError(f"a camera without `{name}` cannot go around: {' '.join(self.block.split())[:60]}")
        return np.array(found[1].split(), np.float64)

    def go(self, right: float, down: float, nearer: float) -> None:
        """Orbits around the target, by shares of a half turn, and zooms."""
        up, away = _unit(self.up), _unit(self.eye - self.target)
        height = np.degrees(np.arcsin(np.clip(away @ up, -1, 1)))
        height = np.clip(height + 180 * down, _STEEPEST - 90, 90 - _STEEPEST)
        level = away - (away @ up) * up
        side = np.cross(up, _unit(level) if np.linalg.norm(level) > 1e-6 else _unit(np.cross(up, [up[1], up[2], up[0]])))
        turned = -np.pi * right
        level = np.cos(turned) * np.cross(side, up) + np.sin(turned) * side
        self.far *= float(np.clip(nearer, 0.01, 100))
        angle = np.radians(height)
        self.eye = self.target + self.far * (np.cos(angle) * level + np.sin(angle) * up)
        self.along = _unit(self.target - self.eye)

    def scene(self) -> str:
        """Returns the scene's text with the camera's current position."""
        block = self.block
        for name, value in (("center", self.eye), ("direction", self.along)):
            words = f"{name} {' '.join(np.format_float_positional(np.float32(x), trim='-') for x in value)}"
            block = re.sub(_FIELD.format(name), words, block, count=1)
        return self.text[: self.start] + block + self.text[self.end :]


def _unit(vector: _Vector) -> _Vector:
    return vector / max(float(np.linalg.norm(vector)), 1e-300)


class Explorer(anywidget.AnyWidget):  # type: ignore[misc, unused-ignore]
    """A world with an orbiting camera, whose pixels can be explained.

    The world is in the scene language, from a file or built in code, with a camera that has
    `center`, `direction` and `up`. Options are those of `World.render`. Drags, the wheel, arrow
    keys, plus and minus move the camera; a click explains a pixel.
    """

    _esm = Path(__file__).with_name("explorer.js")
    _css = """
    .durer img { max-width: 100%; cursor: grab; touch-action: none; }
    .durer-chip { display: inline-block; width: .8em; height: .8em; margin-right: .4em; border: 1px solid #8888; }
    .durer-node { margin-left: 1.1em; font-family: monospace; }
    """
    #: The picture as PNG.
    picture = traitlets.Bytes(b"").tag(sync=True)
    #: Status line: what is shown, or an error.
    word = traitlets.Unicode("").tag(sync=True)
    #: The explanation as nodes: `text`, `color` for CSS, `value` and `terms`.
    told = traitlets.Dict({}).tag(sync=True)
    #: Number of requests of the page that were handled.
    made = traitlets.Int(0).tag(sync=True)

    def __init__(self, world: World, *, size: tuple[int, int] = (480, 360), samples: int = 4, **options: Any) -> None:
        super().__init__()
        self._camera = _Camera(world)
        self._size, self._samples, self._options = size, samples, options
        #: The current world: `explorer.world.save(folder)` saves it.
        self.world = world
        self._draw()
        self.on_msg(self._told_of)

    def _draw(self) -> None:
        pictures = self.world.render(size=self._size, samples=self._samples, progress=False, **self._options)
        self.picture = pictures._repr_png_()
        at = ", ".join(f"{x:.4g}" for x in self._camera.eye)
        self.told, self.word = {}, f"seen from ({at})"

    def _told_of(self, _: Any, wish: dict[str, Any], __: Any) -> None:
        self._hear(wish)

    def _hear(self, wish: dict[str, Any]) -> None:
        """Handles a request of the page: `turn` and `nearer` move the camera, `ask` explains the
        pixel at shares of width and height."""
        try:
            (right, down), nearer, ask = wish["turn"], wish["nearer"], wish["ask"]
            if right or down or nearer != 1:
                self._camera.go(right, down, nearer)
                self.world = self.world.rewritten(self._camera.scene())
                self._draw()
            if ask is not None:
                width, height = self._size
                self.explain(min(int(ask[0] * width), width - 1), min(int(ask[1] * height), height - 1))
        except Exception as error:
            self.word = f"{type(error).__name__}: {error.args[0] if error.args else error}"
        finally:
            self.made += 1

    def explain(self, x: int, y: int) -> dict[str, Any]:
        """Explains a pixel by the ray through its centre, here and in the page."""
        answer = self.world.explain(x, y, size=self._size, samples=1, **self._options)
        samples = [sample["light"] for sample in answer["pixel"]["samples"] if sample["light"] is not None]
        self.told = _told(samples[0], answer) if samples else {}
        self.word = f"pixel {x}, {y}" if samples else f"pixel {x}, {y}: the camera sees nothing there"
        return self.told


def _told(node: dict[str, Any], answer: dict[str, Any]) -> dict[str, Any]:
    """Returns a node of an explanation for the page."""
    # Spectral values have four numbers and no display colour.
    value = [float(x or 0) for x in node["value"]]
    screen = [255 * (1.055 * x ** (1 / 2.4) - 0.055 if x > 0.0031308 else 12.92 * x) for x in np.clip(value, 0, 1)]
    color = f"rgb({', '.join(str(round(x)) for x in screen)})" if len(value) == 3 else "transparent"
    text = f"{_named(node['what'], answer)}: {' '.join(f'{x:.3g}' for x in value)}"
    return {"text": text, "color": color, "value": value, "terms": [_told(term, answer) for term in node["terms"]]}


def _named(what: dict[str, Any], answer: dict[str, Any]) -> str:
    """Describes a node in a few words."""

    def name(kind: str, number: Optional[Any]) -> str:
        return str(answer[kind].get(str(number), f"{kind[:-1]} {number}"))

    kind = str(what["kind"])
    if kind == "ray":
        hit = what["hit"]
        return f"{what['from']} ray to {name('objects', hit['object']) if hit else 'nothing'}"
    if kind == "light":
        shadow = what["shadow"]
        hidden = " in shadow" if shadow and shadow["blocker"] else ""
        return f"{name('lights', what['light'])}{hidden}"
    if kind == "direct":
        light = what["light"]
        return f"direct light of {'the environment' if isinstance(light, str) else next(iter(light))}"
    return kind.replace("_", " ")


__all__ = ["Explorer"]
