"""Options of a render, from keywords or from a command line to the pairs of name and text that the library takes."""

from __future__ import annotations

import difflib
import os
from dataclasses import dataclass
from typing import Any, Mapping, Optional, Sequence

import numpy as np

from . import _durer

#: Options in the library's own form: name without dashes, and text, which is empty for a flag.
Pairs = list[tuple[str, str]]


@dataclass(frozen=True)
class Statement:
    """What the library states of an option."""

    help: str
    #: Name of its value; None for a flag.
    value: Optional[str]
    #: The words that its value may be, where only some are allowed.
    words: Sequence[str]
    #: What it concerns: "reading", "picture" or "work".
    group: str


STATEMENTS = {name: Statement(*rest) for name, *rest in _durer.options()}

#: Old names of options.
_ALIASES = {"weight": "min-throughput", "noise": "noise-threshold", "time": "time-limit"}
#: Options of several whole numbers: what they are, and how many.
_NUMBERS = {"size": ("width and height", 2), "crop": ("left, top, width and height", 4), "shard": ("number and count", 2)}
#: What joins the parts of a value.
_JOINED = {"show": ",", "compat": ",", "shard": "/", "depth-range": " ", "light-range": " "}


def option_name(keyword: str) -> str:
    """The library's name of a keyword."""
    name = keyword.replace("_", "-")
    return _ALIASES.get(name, name)


def is_reading(keyword: str) -> bool:
    """Whether a keyword concerns how a scene is read."""
    stated = STATEMENTS.get(option_name(keyword))
    return stated is not None and stated.group == "reading"


def is_work(keyword: str) -> bool:
    """Whether a keyword changes no bit of a finished picture, as the number of threads does; shards have pictures of their own."""
    name = option_name(keyword)
    return name in STATEMENTS and STATEMENTS[name].group == "work" and not name.startswith("shard")


def pairs(options: Mapping[str, Any], reading: bool) -> Pairs:
    """Keywords as pairs: `size=(640, 480)` is `("size", "640x480")`. With `reading`, those about reading a scene, and `size`, which the
    framing of a model depends on; else all others."""
    found: Pairs = []
    for keyword, value in options.items():
        name = option_name(keyword)
        if name not in STATEMENTS or is_reading(name) != reading and (name, reading) != ("size", True):
            known = [n.replace("-", "_") for n in STATEMENTS if is_reading(n) == reading]
            near = difflib.get_close_matches(keyword, known, 1)
            hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(known)}"
            raise TypeError(f"there is no option {keyword}: {hint}")
        found += [(name, text) for text in _texts(keyword, name, value)]
    return found


def parsed(words: Optional[Sequence[str]]) -> Pairs:
    """Options as they follow `durer render SCENE` as pairs."""
    found: Pairs = []
    rest = iter(words or [])
    for word in rest:
        name, equals, text = word.removeprefix("--").partition("=")
        name = _ALIASES.get(name, name)
        if not word.startswith("--") or name not in STATEMENTS:
            raise ValueError(f"{word} is not an option of a render")
        value = STATEMENTS[name].value
        if not equals and value == "on|off":
            text = "on"
        elif not equals and value is not None:
            values = [next(rest, "") for _ in value.split(" ")]
            text = " ".join(values)
        found.append((name, text))
    return found


def _texts(keyword: str, name: str, value: Any) -> list[str]:
    """The texts of a keyword's value: none where it is left out, several where an option is given several times."""
    takes = STATEMENTS[name].value
    if name == "studio" and value in (None, False, True):
        return [] if value else ["none"]
    if value is None or value is False and takes is None:
        return []
    if takes is None:
        return [""]
    if isinstance(value, bool):
        return ["on" if value else "off"]
    if name == "assets" and not isinstance(value, (str, os.PathLike)):
        return [os.fspath(folder) for folder in value]
    if name in ("depth-range", "light-range"):
        if np.shape(value) != (2,):
            raise ValueError(f"{keyword} must be two numbers, but is {value!r}")
        return [" ".join(repr(float(x)) for x in value)]
    return [_text(name, value)]


def _text(name: str, value: Any) -> str:
    meaning, count = _NUMBERS.get(name, ("", 0))
    if count and not isinstance(value, str):
        numbers = np.asarray(value)
        if numbers.shape != (count,) or numbers.dtype.kind not in "iu" or (numbers < 0).any():
            raise ValueError(f"{name} must be {meaning}, whole numbers, but is {value!r}")
    if isinstance(value, (tuple, list, np.ndarray)):
        parts = [str(x) for x in value]
        if name == "crop" and len(parts) == 4:
            return f"{parts[0]},{parts[1]},{parts[2]}x{parts[3]}"
        return _JOINED.get(name, "x").join(parts)
    if name == "time-limit" and isinstance(value, (int, float)):
        return f"{round(1000 * value)}ms"
    return os.fspath(value) if isinstance(value, os.PathLike) else str(value)
