"""A notebook widget that shows a scene: drag to orbit, click a pixel to see why it has its colour.

    from durer.widget import Explorer

    Explorer(durer.load("scene.txt"))

It needs anywidget: `pip install anywidget`.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from .world import World

try:
    import anywidget
    import traitlets
except ModuleNotFoundError as error:
    raise ModuleNotFoundError("durer.widget needs anywidget: pip install anywidget", name=error.name) from None

_Vector = npt.NDArray[np.float64]

#: A camera's block in the scene language, which nests braces at most once. Comments match first, so
#: that cameras in comments are ignored.
_CAMERA = re.compile(r"#[^\n]*|\b([A-Za-z]+Camera)\s*\{((?:[^{}#]|#[^\n]*|\{[^{}]*\})*)\}")
#: A field with three numbers.
_FIELD = r"\b{}((?:\s+[-+.\deE]+){{3}})"
#: Minimum angle in degrees between the view direction and the vertical.
_STEEPEST = 3.0


class _Camera:
    """The camera of a scene in the scene language, and its target."""

    def __init__(self, world: World) -> None:
        blocks = [found for found in _CAMERA.finditer(world.text) if found[1]]
        if len(blocks) != 1:
            raise ValueError(f"{world.path.name} has no camera in the scene language, so the scene cannot be orbited")
        self.text, (self.start, self.end) = world.text, blocks[0].span()
        self.block = blocks[0][0]
        self.eye, self.along, self.up = (self._field(name) for name in ("center", "direction", "up"))
        hit = world.closest(self.eye, self.along, progress=False)
        met = float(hit.t) * float(np.linalg.norm(self.along))
        # If the camera looks at nothing, it orbits a point at the distance of the origin.
        self.far = met if np.isfinite(met) and met > 0 else max(float(np.linalg.norm(self.eye)), 1.0)
        self.target = self.eye + self.far * _unit(self.along)

    def _field(self, name: str) -> _Vector:
        found = re.search(_FIELD.format(name), self.block)
        if found is None:
            raise ValueError(f"a camera without `{name}` cannot orbit: {' '.join(self.block.split())[:60]}")
        return np.array(found[1].split(), np.float64)

    def go(self, right: float, down: float, zoom: float) -> None:
        """Orbits around the target by fractions of half a turn, and zooms."""
        up, away = _unit(self.up), _unit(self.eye - self.target)
        height = np.degrees(np.arcsin(np.clip(away @ up, -1, 1)))
        height = np.clip(height + 180 * down, _STEEPEST - 90, 90 - _STEEPEST)
        level = away - (away @ up) * up
        side = np.cross(up, _unit(level) if np.linalg.norm(level) > 1e-6 else _unit(np.cross(up, [up[1], up[2], up[0]])))
        turned = -np.pi * right
        level = np.cos(turned) * np.cross(side, up) + np.sin(turned) * side
        self.far *= float(np.clip(zoom, 0.01, 100))
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
    """Notebook widget that shows a world through an orbiting camera, and explains the pixels that
    are clicked.

    The world must come from the scene language, in a file or built in code, and its camera must
    have `center`, `direction` and `up`. Options are those of `World.render`. Drag or use the arrow
    keys to orbit, and use the wheel or the plus and minus keys to zoom.
    """

    _esm = Path(__file__).with_name("explorer.js")
    _css = """
    .durer img { max-width: 100%; cursor: grab; touch-action: none; }
    .durer-chip { display: inline-block; width: .8em; height: .8em; margin-right: .4em; border: 1px solid #8888; }
    .durer-node { margin-left: 1.1em; font-family: monospace; }
    """
    #: The rendered image as PNG.
    picture = traitlets.Bytes(b"").tag(sync=True)
    #: Text of the status line, or of an error.
    status = traitlets.Unicode("").tag(sync=True)
    #: The explanation as a tree of nodes with `text`, `color` for CSS, `value` and `terms`.
    explanation = traitlets.Dict({}).tag(sync=True)
    #: Number of requests from the page that were handled.
    handled = traitlets.Int(0).tag(sync=True)

    def __init__(self, world: World, *, size: tuple[int, int] = (480, 360), samples: int = 4, **options: Any) -> None:
        super().__init__()
        self._camera = _Camera(world)
        self._size, self._samples, self._options = size, samples, options
        #: The world as currently shown; `explorer.world.save(folder)` saves it.
        self.world = world
        self._draw()
        self.on_msg(self._on_message)

    def _draw(self) -> None:
        pictures = self.world.render(size=self._size, samples=self._samples, progress=False, **self._options)
        self.picture = pictures._repr_png_()
        at = ", ".join(f"{x:.4g}" for x in self._camera.eye)
        self.explanation, self.status = {}, f"seen from ({at})"

    def _on_message(self, _: Any, request: dict[str, Any], __: Any) -> None:
        self._handle(request)

    def _handle(self, request: dict[str, Any]) -> None:
        """Handles a request from the page. `turn` and `zoom` move the camera; `ask` explains the
        pixel at fractions of the width and height."""
        try:
            (right, down), zoom, ask = request["turn"], request["zoom"], request["ask"]
            if right or down or zoom != 1:
                self._camera.go(right, down, zoom)
                self.world = self.world.rewritten(self._camera.scene())
                self._draw()
            if ask is not None:
                width, height = self._size
                self.explain(min(int(ask[0] * width), width - 1), min(int(ask[1] * height), height - 1))
        except Exception as error:
            self.status = f"{type(error).__name__}: {error.args[0] if error.args else error}"
        finally:
            self.handled += 1

    def explain(self, x: int, y: int) -> dict[str, Any]:
        """Explains a pixel by the ray through its centre. Returns the explanation and shows it on
        the page."""
        answer = self.world.explain(x, y, size=self._size, samples=1, **self._options)
        samples = [sample["light"] for sample in answer["pixel"]["samples"] if sample["light"] is not None]
        self.explanation = _node(samples[0], answer) if samples else {}
        self.status = f"pixel {x}, {y}" if samples else f"pixel {x}, {y}: the camera sees nothing there"
        return self.explanation


def _node(node: dict[str, Any], answer: dict[str, Any]) -> dict[str, Any]:
    """Converts a node of an explanation to the form that the page shows."""
    # Spectral values have four numbers and no display colour.
    value = [float(x or 0) for x in node["value"]]
    screen = [255 * (1.055 * x ** (1 / 2.4) - 0.055 if x > 0.0031308 else 12.92 * x) for x in np.clip(value, 0, 1)]
    color = f"rgb({', '.join(str(round(x)) for x in screen)})" if len(value) == 3 else "transparent"
    text = f"{_describe(node['what'], answer)}: {' '.join(f'{x:.3g}' for x in value)}"
    return {"text": text, "color": color, "value": value, "terms": [_node(term, answer) for term in node["terms"]]}


def _describe(what: dict[str, Any], answer: dict[str, Any]) -> str:
    """Returns a short description of a node."""

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
