"""Penalty methods: how stiffness, mass and damping penalties are chosen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from bipenalty import checks


@runtime_checkable
class Method(Protocol):
    """What a run needs of a penalty method."""

    @property
    def ps(self) -> float: ...
    @property
    def R(self) -> float | None: ...
    @property
    def R_safety(self) -> float | None: ...
    @property
    def D(self) -> float | None: ...
    @property
    def zeta(self) -> float | None: ...
    @property
    def label(self) -> str: ...


def _not_negative(owner: str, name: str, value: object, remedy: str) -> float:
    number = checks.number(owner, name, value)
    checks.within(owner, name, number, 0 <= number < float("inf"), ">= 0 and finite", remedy)
    return number


@dataclass(frozen=True)
class Stiffness:
    """Stiffness penalty method, with damping if D > 0: alpha_s = ps E_max, alpha_d = D alpha_s.

    Parameters
    ----------
    ps : stiffness penalty factor alpha_s / (E_max 1 m), -, >= 0; E_max is the stiffer body of the pair.
    D : damping penalty factor alpha_d / alpha_s, s, >= 0.

    It lowers the critical time step: omega^2 <= omega_0^2 + alpha_s lambda_max(G M^-1 G') (Belytschko and
    Neal 1991).

    Example
    -------
    >>> Stiffness(ps=1.0, D=0.001).label
    'stiffness (D = 0.001)'
    """

    ps: float = 1.0
    D: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "ps", _not_negative("Stiffness", "ps", self.ps, "try 1"))
        if self.D is not None:
            remedy = "D = alpha_d / alpha_s in s; leave it out for no damping"
            object.__setattr__(self, "D", _not_negative("Stiffness", "D", self.D, remedy))

    @property
    def R(self) -> float | None:
        """No penalty ratio: there is no mass penalty."""
        return None

    @property
    def R_safety(self) -> float | None:
        """No penalty ratio: there is no mass penalty."""
        return None

    @property
    def zeta(self) -> float | None:
        """No damping ratio: there is no penalty mode to take the ratio of."""
        return None

    @property
    def label(self) -> str:
        """Name for legends and tables, without ps."""
        return f"stiffness (D = {self.D:g})" if self.D else "stiffness"


@dataclass(frozen=True)
class Bipenalty:
    """Bipenalty method, with damping if D or zeta is given: alpha_m = alpha_s / R.

    Parameters
    ----------
    ps : stiffness penalty factor alpha_s / (E_max 1 m), -, >= 0.
    R : penalty ratio alpha_s / alpha_m, 1/s^2, > 0; R_safety * 4/dt^2 unless given.
    R_safety : share of 4/dt^2, -, > 0; up to 1 the critical time step is untouched.
    D : damping penalty factor alpha_d / alpha_s, s, >= 0.
    zeta : damping ratio alpha_d / (2 sqrt(alpha_s alpha_m)), -, >= 0; instead of D.

    omega^2 <= max(omega_0^2, R) for any number of rows (Hetherington, Rodriguez-Ferran and Askes 2012).

    Example
    -------
    >>> Bipenalty(ps=10.0, D=0.01).label
    'bipenalty (D = 0.01)'
    """

    ps: float = 1.0
    R: float | None = None
    R_safety: float | None = 0.9
    D: float | None = None
    zeta: float | None = None

    def __post_init__(self) -> None:
        owner = "Bipenalty"
        object.__setattr__(self, "ps", _not_negative(owner, "ps", self.ps, "try 1"))
        for name, remedy in (("R", "leave it out to take it from dt"), ("R_safety", "0.9 keeps dt within its limit")):
            if name == "R" and self.R is None:
                continue
            value = checks.number(owner, name, getattr(self, name))
            checks.within(owner, name, value, 0 < value < float("inf"), "> 0 and finite", remedy)
            object.__setattr__(self, name, value)
        checks.within(owner, "D and zeta", (self.D, self.zeta), self.D is None or self.zeta is None,
                      "given one at a time", "zeta = D sqrt(R) / 2: leave one out")
        for name in ("D", "zeta"):
            if getattr(self, name) is not None:
                remedy = "leave it out for no damping"
                object.__setattr__(self, name, _not_negative(owner, name, getattr(self, name), remedy))

    @property
    def label(self) -> str:
        """Name for legends and tables, without ps."""
        if self.D:
            return f"bipenalty (D = {self.D:g})"
        return f"bipenalty (zeta = {self.zeta:g})" if self.zeta else "bipenalty"
