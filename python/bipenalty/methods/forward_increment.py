"""Forward-increment Lagrange multipliers: complementarity of force and the next gap."""

from __future__ import annotations

from dataclasses import dataclass

from bipenalty.methods.lagrange import Lagrange
from bipenalty.methods.method import Rule


@dataclass(frozen=True)
class ForwardIncrementLagrange(Lagrange):
    """Multipliers of t_n that keep the gaps of t_{n+1} closed; no parameter but the tolerance.

    Parameters
    ----------
    tolerance : gap that may be left at a row over what its own force makes good, -, in [1e-13, 1e-3].

    Where the bodies get without contact, u* = u_n + dt v*, the rows that penetrate are found, and over all of them,
    coupled by W = G M^-1 G',

        0 <= lambda _|_ g_{n+1} >= 0,    g_{n+1} = g(u*) + dt^2 W lambda

    (Carpenter, Taylor and Katona 1991; they enforce equality and release rows in tension afterwards). It is linear in
    the correction from u*: normals and closest points are those at u*, so that against a flat wall the gap closes
    exactly, and elsewhere up to the square of the correction. Rows cost no time step. `penetration` is what is left at
    t_{n+1} to first order, in the entry of t_n.

    Raises
    ------
    InputError : a tolerance out of its bounds.

    Example
    -------
    >>> ForwardIncrementLagrange().label
    'forward-increment Lagrange'
    """

    @property
    def enforcement_rule(self) -> Rule:
        """Complementarity of force and predicted gap."""
        return "forward increment", self.tolerance

    @property
    def label(self) -> str:
        """Name for legends and tables."""
        return "forward-increment Lagrange"
