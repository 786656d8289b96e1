"""The exception for errors in a scene, and conversion of option names in messages to Python
keywords."""

from __future__ import annotations

import json
import re
from typing import Any, Callable, Optional, TypeVar

from . import _durer

T = TypeVar("T")


class SceneError(_durer.SceneError):
    """Raised if a scene cannot be rendered. The text is the command's message. `file`, `line` and
    `column` give the position of the first error that has one, else None. `findings` lists all
    diagnostics, like `durer check --json`."""

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


def with_python_names(work: Callable[[], T]) -> T:
    """Calls `work`, and replaces `--option-name` by `option_name` in the messages of its errors."""
    try:
        return work()
    except _durer.SceneError as error:
        said: ValueError = SceneError(*error.args)
    except ValueError as error:
        said = ValueError(_python(str(error)))
    # Raise outside of `except`, because the native exception would become the context and cannot be
    # pickled.
    raise said


def _python(text: str) -> str:
    text = re.sub(r"expected WIDTHxHEIGHT, for example (\d+)x(\d+)", r'expected (\1, \2) or "\1x\2"', text)
    return re.sub(r"--([a-z][a-z-]*)", lambda option: option[1].replace("-", "_"), text)
