"""Checks of what a mesh is built from; each error names the object, its value, the bound and the remedy."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from bipenalty.errors import InputError

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def coordinates(who: str, value: Any) -> Floats:
    """A new (N, 2) array of finite coordinates."""
    try:
        points = np.array(value, dtype=np.float64, order="C")
    except (TypeError, ValueError):
        raise InputError(f"{who}: points = {value!r}, must be numbers in an (N, 2) array") from None
    if points.ndim != 2 or points.shape[1] != 2:
        hint = "drop the z column with points[:, :2]" if points.shape[1:] == (3,) else "one row for each node"
        raise InputError(f"{who}: points has shape {points.shape}, must be (N, 2); {hint}")
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        node = tuple(points[bad[0]].tolist())
        raise InputError(
            f"{who}: points[{bad[0]}] = {node}, must be finite; mend the coordinates ({len(bad)} such nodes)"
        )
    return points


def connectivity(who: str, what: str, value: Any, columns: int) -> Ints:
    """A new (count, columns) array of node numbers, not yet known to be in range."""
    if value is None:
        return np.empty((0, columns), dtype=np.int64)
    remedy = f"{columns} node numbers in each row"
    try:
        array = np.asarray(value)
    except ValueError:  # rows of different lengths
        raise InputError(f"{who}: {what} has rows of different lengths, must be an array; {remedy}") from None
    if array.size == 0:
        return np.empty((0, columns), dtype=np.int64)
    if array.ndim != 2 or array.shape[1] != columns:
        raise InputError(f"{who}: {what} has shape {array.shape}, must be (count, {columns}); {remedy}")
    if not np.issubdtype(array.dtype, np.integer):
        raise InputError(f"{who}: {what} has dtype {array.dtype}, must be of integers; use astype(int)")
    return np.array(array, dtype=np.int64, order="C")


def finite(who: str, what: str, value: Any) -> float:
    """A finite number."""
    if not _is_number(value) or not math.isfinite(value):
        raise InputError(f"{who}: {what} = {value!r}, must be a finite number")
    return float(value)


def positive(who: str, what: str, value: Any, remedy: str = "give a length in m") -> float:
    """A finite number greater than zero."""
    if not _is_number(value) or not 0 < value < math.inf:
        raise InputError(f"{who}: {what} = {value!r}, must be a finite number > 0; {remedy}")
    return float(value)


def count(who: str, what: str, value: Any, multiple_of: int = 1) -> int:
    """An integer that is a positive multiple of another."""
    whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not whole or value < multiple_of or value % multiple_of:
        usable = _is_number(value) and math.isfinite(value)
        near = max(multiple_of, multiple_of * round(value / multiple_of)) if usable else multiple_of
        kind = "integer >= 1" if multiple_of == 1 else f"positive multiple of {multiple_of}"
        raise InputError(f"{who}: {what} = {value!r}, must be a{'n' * (multiple_of == 1)} {kind}; {near} would do")
    return int(value)


def point(who: str, what: str, value: Any) -> Floats:
    """A point, two finite numbers."""
    try:
        xy = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        xy = np.empty(0)
    if xy.shape != (2,) or not np.isfinite(xy).all():
        raise InputError(f"{who}: {what} = {value!r}, must be two finite numbers; give (x, y) in m")
    return xy


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
