"""Reads and compares image files."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _durer
from ._arrays import Floats, as_array
from .world import PathLike, Pictures, shown_with, write_atomically


def read(path: PathLike) -> tuple[Floats, bool]:
    """Reads an image file in any format that the command writes. Returns the values without
    conversion, of shape (height, width, 3), and True if they are display values from 0 to 1 instead
    of linear light.

    >>> paths = world.render(size=(40, 30), samples=1).save("picture.png")
    >>> values, is_display = durer.read("picture.png")
    >>> values.shape, is_display
    ((30, 40, 3), True)
    """
    values, width, height, display = _durer.decode(Path(path).read_bytes(), os.fspath(path))
    return values.reshape(height, width, 3), display


def write(
    path: PathLike,
    picture: npt.ArrayLike,
    *,
    transfer: str = "srgb",
    exposure: float = 0.0,
    tone: str = "none",
    bits: int = 8,
) -> None:
    """Writes an array of shape (height, width, 3), or (height, width) for grey, to an image file:
    png, jpg, webp, tga, bmp, ppm, pfm, hdr or exr. Values of type uint8 are display values, which
    are stored unchanged; others are linear light, to which `exposure`, `tone` and `transfer` are
    applied as in `Pictures.save`. For data from 0 to 1, use `transfer="linear"`.

    >>> durer.write("grey.png", np.full((30, 40), 0.5), transfer="linear")
    """
    array = as_array("picture", picture)
    values, is_display = _scaled("picture", np.stack([array] * 3, axis=-1) if array.ndim == 2 else array)
    shown = shown_with(transfer, exposure, tone, bits)
    content = _durer.encode(os.fspath(path), [("color", values, None, not is_display)], shown)
    write_atomically(Path(path), content)


def compare(
    reference: Union[npt.ArrayLike, PathLike, Pictures],
    picture: Union[npt.ArrayLike, PathLike, Pictures],
    *,
    tolerance: float = 1 / 255,
    allowed: float = 0.0,
) -> dict[str, Any]:
    """Compares an image with a reference. The result has the contents of `durer compare --json`
    (RMSE, PSNR, SSIM, FLIP, the worst regions, and explanations of the difference) and `flip_map`,
    the FLIP error of each pixel.

    Images are files, results of `render`, or arrays of shape (height, width, 3): uint8 for display
    values, floating point for linear light. `allowed` is the fraction of pixels that may differ by
    more than the tolerance.

    >>> picture = np.zeros((30, 40, 3), np.float32)
    >>> found = durer.compare(picture, picture + 0.5)
    >>> found["flip_map"].shape
    (30, 40)
    """
    a, b = _scaled("reference", reference), _scaled("picture", picture)
    text, flip = _durer.compare(a, b, tolerance, allowed)
    answer: dict[str, Any] = json.loads(text)
    answer["flip_map"] = flip.reshape(a[0].shape[:2])
    return answer


def _scaled(name: str, value: Any) -> tuple[Floats, bool]:
    if isinstance(value, Pictures):
        return np.ascontiguousarray(value["color"]), False
    if isinstance(value, (str, os.PathLike)):
        return read(value)
    array = as_array(name, value)
    if array.ndim != 3 or array.shape[2] not in (3, 4):
        raise ValueError(f"{name} must have the shape (height, width, 3), but has {array.shape}")
    display = array.dtype == np.uint8
    values = np.ascontiguousarray(array[..., :3], dtype=np.float32)
    return (values / np.float32(255) if display else values), display
