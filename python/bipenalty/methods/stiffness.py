"""The stiffness penalty method."""

from __future__ import annotations

from dataclasses import dataclass

from bipenalty.methods.method import NO_RULE, Rule, StiffnessOnly, settle


@dataclass(frozen=True)
class Stiffness(StiffnessOnly):
    """Stiffness penalty method, with damping if D is given: alpha_s = ps E_max, alpha_d = D alpha_s.

    Parameters
    ----------
    ps : stiffness penalty factor alpha_s / (E_max 1 m), -, >= 0; E_max is the stiffer body of the pair.
    D : damping penalty factor alpha_d / alpha_s, s, >= 0; none unless given.

    It lowers the critical time step: omega^2 <= omega_0^2 + alpha_s lambda_max(G M^-1 G') (Belytschko and
    Neal 1991). `Model.critical_step()` says how far.

    Raises
    ------
    InputError : a parameter out of its bounds.

    Example
    -------
    >>> Stiffness(ps=1.0, D=0.001).label
    'stiffness (D = 0.001)'
    """

    ps: float = 1.0
    D: float | None = None

    def __post_init__(self) -> None:
        settle(self, "ps", "D", required="ps")

    @property
    def stiffness_rule(self) -> Rule:
        """alpha_s = ps E_max."""
        return "factor", self.ps

    @property
    def damping_rule(self) -> Rule:
        """alpha_d = D alpha_s."""
        return NO_RULE if self.D is None else ("factor", self.D)

    @property
    def label(self) -> str:
        """Name for legends and tables, without ps."""
        return f"stiffness (D = {self.D:g})" if self.D else "stiffness"
