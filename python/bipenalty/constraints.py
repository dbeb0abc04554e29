"""Constraints other than contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, eq=False)
class Support:
    """Nodes of a body held in x, y or both; exact, and without cost in the step.

    Parameters
    ----------
    body : name of the body.
    on : name of one of its mesh's boundaries, or an array of its node numbers.
    x, y : which axes are held.
    """

    body: str
    on: Any
    x: bool = True
    y: bool = True
