"""The fingerprint of a call: equal for equal scenes, plans and options, in any process."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from bipenalty.methods.method import Method


def fingerprint(*values: Any) -> str:
    """SHA-256 over numbers, text, arrays, sequences, mappings, dataclasses and methods.

    Example
    -------
    >>> fingerprint(1.0, "a") == fingerprint(1.0, "a"), fingerprint(1.0) == fingerprint(2.0)
    (True, False)
    """
    digest = hashlib.sha256()
    _feed(digest, values)
    return digest.hexdigest()


def _feed(digest: Any, value: Any) -> None:
    """Every value with its kind and length first, so that no two run together."""
    if value is None or isinstance(value, (bool, int, float, str, np.generic)):
        plain = value.item() if isinstance(value, np.generic) else value
        _put(digest, type(plain).__name__, repr(plain).encode())
    elif isinstance(value, np.ndarray):
        _put(digest, f"array {value.dtype.str} {value.shape}", np.ascontiguousarray(value).tobytes())
    elif isinstance(value, type):
        _put(digest, "class", value.__qualname__.encode())
    elif isinstance(value, Method):
        rules = (value.stiffness_rule, value.kappa_rule, value.mass_rule, value.damping_rule, value.label)
        _feed(digest, (type(value).__qualname__, rules, getattr(value, "enforcement_rule", None)))
    elif dataclasses.is_dataclass(value):
        fields = [(field.name, getattr(value, field.name)) for field in dataclasses.fields(value)]
        _feed(digest, (type(value).__qualname__, fields))
    elif isinstance(value, Mapping):
        _feed(digest, sorted(value.items()))
    else:
        items = list(value)
        _put(digest, "sequence", str(len(items)).encode())
        for item in items:
            _feed(digest, item)


def _put(digest: Any, kind: str, content: bytes) -> None:
    digest.update(f"{kind} {len(content)}:".encode() + content)
