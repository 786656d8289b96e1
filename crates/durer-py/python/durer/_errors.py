"""The exception for errors in a scene, and messages about wrong arguments."""

from __future__ import annotations

import difflib
import functools
import inspect
import json
import re
from types import FunctionType
from typing import Any, Callable, Iterable, Optional, TypeVar, Union

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


def check_type(name: str, value: Any, types: Union[type, tuple[type, ...]], wanted: str) -> None:
    """Raises TypeError unless the argument `name` is of one of the types."""
    if not isinstance(value, types):
        raise TypeError(f"{name} must be {wanted}, but is of type {type(value).__name__}")


def hint(word: str, known: Iterable[str], otherwise: str) -> str:
    """Suggests the known word that is most similar to an unknown one."""
    near = difflib.get_close_matches(word, list(known), 1)
    return f"did you mean {near[0]}?" if near else otherwise


def with_hints(cls: type[T]) -> type[T]:
    """Makes the methods of a class suggest the keyword that was meant in place of an unknown
    one."""
    for name, method in list(vars(cls).items()):
        if isinstance(method, FunctionType) and (name == "__init__" or not name.startswith("_")):
            setattr(cls, name, _hinting(method, cls.__name__ if name == "__init__" else name))
    return cls


def _hinting(method: FunctionType, name: str) -> Callable[..., Any]:
    parameters = inspect.signature(method).parameters.values()
    if any(parameter.kind is parameter.VAR_KEYWORD for parameter in parameters):
        return method
    known = [parameter.name for parameter in parameters][1:]

    @functools.wraps(method)
    def call(*given: Any, **words: Any) -> Any:
        for word in words:
            if word not in known:
                suggestion = hint(word, known, f"its arguments are {', '.join(known)}")
                raise TypeError(f"{name}() has no argument {word}: {suggestion}")
        return method(*given, **words)

    # Errors about missing arguments show this name, and the class may be private.
    method.__qualname__ = name
    return call
