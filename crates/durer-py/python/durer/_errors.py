"""What is wrong with a scene, as an exception; and messages about options in the words of Python."""

from __future__ import annotations

import json
import re
from typing import Any, Callable, Optional, TypeVar

from . import _durer

T = TypeVar("T")


class SceneError(_durer.SceneError):
    """A scene of which no picture can be made. Reads as the command's message; `file`, `line` and `column` are those of the first
    error that has a place, else None; `findings` all that was found, as `durer check --json` lists it."""

    def __init__(self, message: str, findings: str = "[]") -> None:
        super().__init__(message, findings)
        self.findings: list[dict[str, Any]] = json.loads(findings)
        places = (found.get("place") for found in self.findings if found.get("severity") == "error")
        place: dict[str, Any] = next((place for place in places if place), {})
        self.file: Optional[str] = place.get("file")
        self.line: Optional[int] = place.get("line")
        self.column: Optional[int] = place.get("column")

    def __str__(self) -> str:
        return str(self.args[0])


SceneError.__module__ = "durer"


def spoken(work: Callable[[], T]) -> T:
    """Does something; options in what is said of it are spelled as keywords."""
    try:
        return work()
    except _durer.SceneError as error:
        said: ValueError = SceneError(*error.args)
    except ValueError as error:
        said = ValueError(_python(str(error)))
    # Here, for the native exception is nobody's context: that could not be pickled.
    raise said


def _python(text: str) -> str:
    text = re.sub(r"say it as (\d+)x(\d+)", r'say it as (\1, \2) or "\1x\2"', text)
    return re.sub(r"--([a-z][a-z-]*)", lambda option: option[1].replace("-", "_"), text)
