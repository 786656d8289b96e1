"""Converts render options from keywords or a command line to pairs of name and text, as the library
expects them."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Mapping, Optional, Sequence

import numpy as np

from . import _durer
from ._errors import hint

#: Options as pairs: the name without leading dashes, and the value as text, empty for a flag.
Pairs = list[tuple[str, str]]


@dataclass(frozen=True)
class OptionInfo:
    """Description of a render option, from the library's table."""

    help: str
    #: Name of its value; None for a flag.
    value: Optional[str]
    #: Allowed values; empty if any value is allowed.
    words: Sequence[str]
    #: What the option affects: "reading" the scene, the "picture", or only the "work".
    group: str


OPTIONS = {name: OptionInfo(help, value, words, group) for name, help, value, words, group in _durer.options()}

#: Old names of options and their current names.
_ALIASES = {"weight": "min-throughput", "noise": "noise-threshold", "time": "time-limit"}
#: Options that take several integers: the meaning and number of the integers.
_NUMBERS = {"size": ("width and height", 2), "crop": ("left, top, width and height", 4), "shard": ("number and count", 2)}
#: Separators between the parts of a value.
_JOINED = {"show": ",", "compat": ",", "shard": "/", "depth-range": " ", "light-range": " "}


def option_name(keyword: str) -> str:
    """Returns the library's name of the option that a keyword sets."""
    name = keyword.replace("_", "-")
    return _ALIASES.get(name, name)


def is_reading(keyword: str) -> bool:
    """Returns True if a keyword affects how a scene is read."""
    info = OPTIONS.get(option_name(keyword))
    return info is not None and info.group == "reading"


def is_work(keyword: str) -> bool:
    """Returns True if a keyword does not change the finished image, such as the number of threads.
    `shard` does change it."""
    name = option_name(keyword)
    return name in OPTIONS and OPTIONS[name].group == "work" and not name.startswith("shard")


def pairs(options: Mapping[str, Any], reading: bool) -> Pairs:
    """Converts keywords to pairs: `size=(640, 480)` becomes `("size", "640x480")`. If `reading` is
    true, only options about reading a scene are accepted, and `size`, because it affects how a
    model is framed; otherwise only the others."""
    found: Pairs = []
    for keyword, value in options.items():
        name = option_name(keyword)
        if name not in OPTIONS or is_reading(name) != reading and (name, reading) != ("size", True):
            if name in OPTIONS:
                where = "durer.load" if is_reading(name) else "render"
                raise TypeError(f"{keyword} is an option of {where}")
            known = [n.replace("-", "_") for n in OPTIONS if is_reading(n) == reading]
            raise TypeError(f"there is no option {keyword}: {hint(keyword, known, 'durer.options() lists them all')}")
        found += [(name, text) for text in _texts(keyword, name, value)]
    return found


def parse_words(words: Optional[Sequence[str]]) -> Pairs:
    """Converts command line options, as written after `durer render SCENE`, to pairs."""
    found: Pairs = []
    rest = iter(words or [])
    for word in rest:
        name, equals, text = word.removeprefix("--").partition("=")
        name = _ALIASES.get(name, name)
        if not word.startswith("--") or name not in OPTIONS:
            raise ValueError(f"{word} is not a render option")
        value = OPTIONS[name].value
        if not equals and value == "on|off":
            text = "on"
        elif not equals and value is not None:
            values = [next(rest, "") for _ in value.split(" ")]
            text = " ".join(values)
        found.append((name, text))
    return found


def _texts(keyword: str, name: str, value: Any) -> list[str]:
    """Returns the value of a keyword as texts: none if the option is not set, several if it is
    repeated."""
    takes = OPTIONS[name].value
    if name == "studio" and value in (None, False, True):
        return [] if value else ["none"]
    if value is None or value is False and takes is None:
        return []
    if takes is None:
        return [""]
    if isinstance(value, bool):
        return ["on" if value else "off"]
    if name in ("depth-range", "light-range"):
        if np.shape(value) != (2,):
            raise ValueError(f"{keyword} must be two numbers, but is {value!r}")
        return [" ".join(repr(float(x)) for x in value)]
    if name == "assets" and not isinstance(value, (str, os.PathLike)):
        return [os.fspath(folder) for folder in value]
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
