"""Shows the progress of long operations as a line on standard error, if it is a terminal, after the
first second."""

from __future__ import annotations

import sys
import time
from typing import Callable, Optional, TypeAlias, Union

from ._errors import check_type

Watch: TypeAlias = Callable[[int, int], object]
Progress: TypeAlias = Union[None, bool, Watch]


#: Number of items below which an operation finishes so quickly that no progress is shown.
_MIN_ITEMS = 1 << 14


def watch(progress: Progress, count: int = _MIN_ITEMS) -> Optional[Watch]:
    """Returns the progress callback: `progress` if it is a function, otherwise one that draws a
    line on the terminal; None if there are few items or no terminal."""
    if callable(progress):
        return progress
    check_type("progress", progress, (bool, type(None)), "a function of two numbers, True, False or None")
    if progress is False or progress is None and count < _MIN_ITEMS or progress is None and not sys.stderr.isatty():
        return None
    start = time.monotonic()

    def show(done: int, total: int) -> None:
        if time.monotonic() - start < 1.0:
            return
        share = done / max(total, 1)
        line = f"\r{'=' * round(40 * share):40} {100 * share:3.0f} %"
        sys.stderr.write("\r" + " " * 48 + "\r" if done >= total else line)
        sys.stderr.flush()

    return show
