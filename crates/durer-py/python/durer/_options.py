"""Converts options of a render from keywords or a command line to pairs of name and text for the
library."""

from __future__ import annotations

import difflib
import os
from dataclasses import dataclass
from typing import Any, Mapping, Optional, Sequence

import numpy as np

from . import _durer

#: Options in the library's form: name without dashes, and text, which is empty for a flag.
Pairs = list[tuple[str, str]]


@dataclass(frozen=True)
class Statement:
    """The library's statement of an option."""

    help: str
    #: Name of its value; None for a flag.
    value: Optional[str]
    #: Allowed words, if only some are allowed.
    words: Sequence[str]
    #: Subject: "reading", "picture" or "work".
    group: str


STATEMENTS = {name: Statement(help, value, words, group) for name, help, value, words, group in _durer.options()}

#: Old names of options.
_ALIASES = {"weight": "min-throughput", "noise": "noise-threshold", "time": "time-limit"}
#: Options of several integers: their meaning and number.
_NUMBERS = {"size": ("width and height", 2), "crop": ("left, top, width and height", 4), "shard": ("number and count", 2)}
#: Separators between the parts of a value.
_JOINED = {"show": ",", "compat": ",", "shard": "/", "depth-range": " ", "light-range": " "}


def option_name(keyword: str) -> str:
    """Returns the library's name of a keyword."""
    name = keyword.replace("_", "-")
    return _ALIASES.get(name, name)


def is_reading(keyword: str) -> bool:
    """Returns True if a keyword concerns reading a scene."""
    stated = STATEMENTS.get(option_name(keyword))
    return stated is not None and stated.group == "reading"


def is_work(keyword: str) -> bool:
    """Returns True if a keyword changes no bit of a finished picture, such as the number of
    threads. Shards have different pictures."""
    name = option_name(keyword)
    return name in STATEMENTS and STATEMENTS[name].group == "work" and not name.startswith("shard")


def pairs(options: Mapping[str, Any], reading: bool) -> Pairs:
    """Converts keywords to pairs: `size=(640, 480)` becomes `("size", "640x480")`. With
    `reading`, those about reading a scene, and `size`, which the framing of a model depends on;
    otherwise all others."""
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
    """Converts options as they follow `durer render SCENE` to pairs."""
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
    """Returns the texts of a keyword's value: none if it is left out, several if an option is
    repeated."""
    takes = STATEMENTS[name].value
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
