"""What Lagrange multiplier methods share: no penalties, one tolerance."""

from __future__ import annotations

from dataclasses import dataclass

from bipenalty.methods.method import Rule, StiffnessOnly, settle


@dataclass(frozen=True)
class Lagrange(StiffnessOnly):
    """A method without penalties: the row forces solve a complementarity problem, to a tolerance.

    The rows in force are found by block principal pivoting (Judice and Pires 1994) with Murty's single exchanges to
    fall back on; a step usually takes one to three factorisations of the envelope of G M^-1 G'. The tolerance stands
    on its diagonal, so that redundant rows (a second pass) share what one of them would carry.
    """

    tolerance: float = 1e-10

    def __post_init__(self) -> None:
        settle(self, "tolerance", required="tolerance")

    @property
    def stiffness_rule(self) -> Rule:
        """No stiffness penalty."""
        return "none", 0.0

    @property
    def enforcement_rule(self) -> Rule:
        """Which multipliers, and their tolerance."""
        raise NotImplementedError

    @property
    def label(self) -> str:
        """Name for legends and tables."""
        raise NotImplementedError
