"""Progress of long work: a line on standard error, on a terminal, after the first second."""

from __future__ import annotations

import sys
import time
from typing import Callable, Optional, TypeAlias, Union

Watch: TypeAlias = Callable[[int, int], object]
Progress: TypeAlias = Union[None, bool, Watch]


#: Number of items below which work finishes before a user could notice.
_LITTLE = 1 << 14


def watch(progress: Progress, count: int = _LITTLE) -> Optional[Watch]:
    """Returns the progress callback: the given function, or a line on a terminal unless there
    are few items."""
    if callable(progress):
        return progress
    if progress is False or progress is None and count < _LITTLE or progress is None and not sys.stderr.isatty():
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
