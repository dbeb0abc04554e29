"""Checks shared by the scene's objects: each failure is one sentence."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from bipenalty.errors import InputError

Pair = tuple[float, float]


def number(owner: str, name: str, value: Any) -> float:
    """`value` as a float, or an InputError that names owner, quantity and value."""
    try:
        return float(value)
    except (TypeError, ValueError):
        raise InputError(f"{owner}: {name} = {value!r}, must be a number; give one in SI units") from None


def within(owner: str, name: str, value: Any, ok: bool, bound: str, remedy: str) -> None:
    """Raise `owner: name = value, must be bound; remedy` unless `ok`."""
    if not ok:
        raise InputError(f"{owner}: {name} = {value}, must be {bound}; {remedy}")


def text(owner: str, name: str, value: Any) -> str:
    """`value` as a name that is not empty."""
    within(owner, name, repr(value), isinstance(value, str) and value != "", "a name", "give it as a string")
    return str(value)


def whole(owner: str, name: str, value: Any, least: int, most: int = 2**53) -> int:
    """`value` as an integer from least to most."""
    integer = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    known = {least + 1: f"{least} or {most}", 2**53: f"a whole number >= {least} (and <= 2^53)"}
    bound = known.get(most, f"a whole number from {least} to {most}")
    within(owner, name, repr(value), bool(integer) and least <= int(value) <= most, bound, "correct it")
    return int(value)


def method(owner: str, name: str, value: Any) -> Any:
    """`value` as a penalty method: an object, not its class."""
    from bipenalty.methods.method import Method

    ok = isinstance(value, Method) and not isinstance(value, type)
    what = value.__name__ if isinstance(value, type) else type(value).__name__
    kind = "the class " + what if isinstance(value, type) else what
    within(owner, name, kind, ok, "a Stiffness or Bipenalty", "make one with Stiffness(ps) or Bipenalty(ps)")
    return value


def sequence(owner: str, name: str, value: Any) -> tuple[Any, ...]:
    """`value` as a tuple; a lone object is not taken for a list of one."""
    try:
        return tuple(value)
    except TypeError:
        what = type(value).__name__
        raise InputError(f"{owner}: {name} = {what}, must be a list; put it in brackets") from None


def pair(owner: str, name: str, value: Any) -> Pair:
    """`value` as two finite floats."""
    try:
        x, y = (float(v) for v in value)
    except (TypeError, ValueError):
        raise InputError(f"{owner}: {name} = {value!r}, must be two numbers; give (x, y)") from None
    within(owner, name, (x, y), math.isfinite(x) and math.isfinite(y), "finite", "mend the value")
    return x, y


def nodal(owner: str, name: str, value: Any, nodes: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """`value` as an (nodes, 2) array of finite floats; one pair stands for every node."""
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{owner}: {name} is not numeric; give (x, y) or an ({nodes}, 2) array") from None
    within(
        owner,
        f"shape of {name}",
        array.shape,
        array.shape in ((2,), (nodes, 2)),
        f"(2,) or ({nodes}, 2)",
        "give one pair, or one row a node",
    )
    bad = ~np.isfinite(array)
    within(owner, name, array[bad][:1], not bad.any(), "finite", "mend the values")
    return np.ascontiguousarray(np.broadcast_to(array, (nodes, 2)))
