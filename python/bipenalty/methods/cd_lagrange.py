"""CD-Lagrange: complementarity of impulse and velocity."""

from __future__ import annotations

from dataclasses import dataclass

from bipenalty.methods.lagrange import Lagrange
from bipenalty.methods.method import Rule


@dataclass(frozen=True)
class CDLagrange(Lagrange):
    """Central differences with Lagrange multipliers on the velocity; no parameter but the tolerance.

    Parameters
    ----------
    tolerance : approach that may be left at a row over the velocity change its own force makes, -, in [1e-13, 1e-3].

    Over all rows that penetrate at t_n (g_n < 0), coupled by W = G M^-1 G',

        0 <= lambda _|_ G v_{n+1/2} >= 0,    G v_{n+1/2} = G v* + W dt lambda,

    v* the velocity without contact (Fekak, Brun, Gravouil and Depale 2017). A node that arrives gives up its velocity
    at once, restitution 0, and stays as deep as the step of its arrival took it, v_n dt at most: the gap itself is
    not corrected. Rows cost no time step: they only take degrees of freedom away.

    Raises
    ------
    InputError : a tolerance out of its bounds.

    Example
    -------
    >>> CDLagrange().label
    'CD-Lagrange'
    """

    @property
    def enforcement_rule(self) -> Rule:
        """Complementarity of impulse and gap rate."""
        return "velocity Lagrange", self.tolerance

    @property
    def label(self) -> str:
        """Name for legends and tables."""
        return "CD-Lagrange"
