"""Penalty methods: how stiffness, mass and damping penalties are chosen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from bipenalty import _core, checks


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


def _settle(method: Method, *optional: str) -> None:
    """Make every parameter a float and let the core check its bounds."""
    owner = type(method).__name__
    object.__setattr__(method, "ps", checks.number(owner, "ps", method.ps))
    for name in optional:
        if getattr(method, name) is not None:
            object.__setattr__(method, name, checks.number(owner, name, getattr(method, name)))
    _core.check_method(owner, method)


@dataclass(frozen=True)
class Stiffness:
    """Stiffness penalty method, with damping if D > 0: alpha_s = ps E_max, alpha_d = D alpha_s.

    Parameters
    ----------
    ps : stiffness penalty factor alpha_s / (E_max 1 m), -, >= 0; E_max is the stiffer body of the pair.
    D : damping penalty factor alpha_d / alpha_s, s, >= 0; none unless given.

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
        _settle(self, "D")

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
        given = self.D is None or self.zeta is None
        checks.within(
            "Bipenalty",
            "D and zeta",
            (self.D, self.zeta),
            given,
            "given one at a time",
            "zeta = D sqrt(R) / 2: leave one out",
        )
        checks.within(
            "Bipenalty",
            "R_safety",
            self.R_safety,
            self.R is not None or self.R_safety is not None,
            "given unless R is",
            "0.9 keeps dt within its limit; for no mass penalty use Stiffness",
        )
        _settle(self, "R", "R_safety", "D", "zeta")

    @property
    def label(self) -> str:
        """Name for legends and tables, without ps."""
        if self.D:
            return f"bipenalty (D = {self.D:g})"
        return f"bipenalty (zeta = {self.zeta:g})" if self.zeta else "bipenalty"
