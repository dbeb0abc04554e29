"""Contacts: who may touch whom."""

from __future__ import annotations

from dataclasses import dataclass

from bipenalty import checks


@dataclass(frozen=True)
class Contact:
    """Frictionless contact of a secondary body's nodes with a primary body's or obstacle's segments.

    Parameters
    ----------
    secondary, primary : names; the secondary must be a body.
    passes : 1, or 2 for the other way round as well.
    overlap_tolerance : m; overlap allowed at the start, 1e-6 of the mean segment length unless given.
    """

    secondary: str
    primary: str
    passes: int = 1
    overlap_tolerance: float | None = None

    def __post_init__(self) -> None:
        checks.text("contact", "secondary", self.secondary)
        checks.text("contact", "primary", self.primary)
        owner = f'contact "{self.secondary}" on "{self.primary}"'
        object.__setattr__(self, "passes", checks.whole(owner, "passes", self.passes, 1, 2))
        if self.overlap_tolerance is not None:
            tolerance = checks.number(owner, "overlap_tolerance", self.overlap_tolerance)
            object.__setattr__(self, "overlap_tolerance", tolerance)
