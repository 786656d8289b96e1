"""Converts arguments to numpy arrays of the required shape and type. Copies only if the type or the
layout differs."""

from __future__ import annotations

from typing import Any, TypeAlias, Union

import numpy as np
import numpy.typing as npt

Floats: TypeAlias = npt.NDArray[np.float32]
Doubles: TypeAlias = npt.NDArray[np.float64]
Ints: TypeAlias = npt.NDArray[np.int32]
Bools: TypeAlias = npt.NDArray[np.bool_]
#: Points in space: single or double precision.
Points: TypeAlias = Union[Floats, Doubles]

_KINDS = {"f": "numbers", "i": "whole numbers", "u": "whole numbers", "b": "numbers"}


def as_array(name: str, value: Any) -> npt.NDArray[Any]:
    """Converts a value to an array: an array, a list, or any object with DLPack (torch, jax,
    cupy on the host)."""
    if not isinstance(value, np.ndarray) and hasattr(value, "__dlpack__") and not hasattr(value, "__array__"):
        value = np.from_dlpack(value)
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{name} must be an array of numbers: {error}") from None
    if array.dtype.kind not in _KINDS:
        raise TypeError(f"{name} must be an array of numbers, but its type is {array.dtype}")
    return array


def as_vectors(name: str, value: Any, width: int = 3) -> Floats:
    """Converts a value to float32 of shape (..., width)."""
    array = as_array(name, value)
    if array.ndim == 0 or array.shape[-1] != width:
        raise ValueError(f"{name} must have the shape (..., {width}), but has {array.shape}")
    with np.errstate(over="ignore"):
        return np.asarray(array, dtype=np.float32)


def as_points(name: str, value: Any) -> Points:
    """Converts points of shape (..., 3). Float32 stays float32, all other types become float64."""
    array = as_array(name, value)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"{name} must have the shape (..., 3), but has {array.shape}")
    return array if array.dtype in (np.float32, np.float64) else array.astype(np.float64)


def rows(array: npt.NDArray[Any], width: int) -> npt.NDArray[Any]:
    """Returns an array as a contiguous array of shape (n, width)."""
    return np.ascontiguousarray(array.reshape(-1, width))


def as_indices(name: str, value: Any, width: int = 3) -> npt.NDArray[np.uint32]:
    """Converts a value to non-negative integers of shape (n, width). Always copies."""
    array = as_array(name, value)
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"{name} must have the shape (n, {width}), but has {array.shape}")
    if array.dtype.kind not in "iu" and not (array.size == 0 or bool((array == np.floor(array)).all())):
        raise TypeError(f"{name} must be whole numbers, but the type is {array.dtype}")
    if array.size and (array.min() < 0 or array.max() > 0xFFFF_FFFF):
        raise ValueError(f"{name} must be 0 or more, but the least is {array.min()} and the greatest {array.max()}")
    return np.array(array, dtype=np.uint32, order="C")


def as_scalars(name: str, value: Any, shape: tuple[int, ...]) -> Floats:
    """Converts a value to a single float32, or to float32 of the given shape."""
    if type(value) is float:
        return np.array([value], np.float32)
    array = as_array(name, value)
    if array.ndim == 0:
        return np.asarray(array, dtype=np.float32).reshape(1)
    if array.shape != shape:
        raise ValueError(f"{name} must be one number or have the shape {shape}, but has {array.shape}")
    return np.ascontiguousarray(array, dtype=np.float32).reshape(-1)


def as_matrix(name: str, value: Any) -> Doubles:
    """Converts an affine map, given as 3 x 4 or as 4 x 4 with the last row 0 0 0 1, to three
    rows of four numbers."""
    array = np.asarray(as_array(name, value), dtype=np.float64)
    if array.shape not in ((3, 4), (4, 4)):
        raise ValueError(f"{name} must be 3 x 4, or 4 x 4 with the last row 0 0 0 1, but has the shape {array.shape}")
    if array.shape == (4, 4) and not (array[3] == (0, 0, 0, 1)).all():
        raise ValueError(f"the last row of {name} must be 0 0 0 1, but is {' '.join(f'{x:g}' for x in array[3])}")
    array = array[:3]
    if not np.isfinite(array).all():
        raise ValueError(f"{name} has numbers that are not finite")
    return np.ascontiguousarray(array)


def finite(array: npt.NDArray[Any]) -> Bools:
    """Returns a mask of the rows whose numbers are all finite."""
    answer: Bools = np.logical_and.reduce(np.isfinite(array), axis=-1)
    return answer
