"""Predictor-corrector bipenalty: the mass penalty acts on the correction alone."""

from __future__ import annotations

from dataclasses import dataclass

from bipenalty.methods.method import Rule, StiffnessOnly, settle


@dataclass(frozen=True)
class PredictorCorrector(StiffnessOnly):
    """Bipenalty whose mass penalty sees only the corrector's acceleration: a force a row, no block to solve.

    Parameters
    ----------
    ps : stiffness penalty factor alpha_s / (E_max 1 m), -, >= 0.
    s2 : s^2 = R dt^2 of the mass penalty alpha_m = alpha_s dt^2/s^2, -, in (0, 1].

    The predictor takes the bodies to u* = u_n + dt v* without contact; rows are those that penetrate there. The
    corrector's acceleration is M^-1 G' lambda, and with w = G M^-1 G' of a row alone

        lambda = -(alpha_s g(u*) + alpha_m w lambda) = -alpha_s g(u*) / (1 + alpha_m w),
        g_{n+1} = (1 - d) g(u*),    d = alpha_s w dt^2 / (1 + alpha_m w) < s^2.

    It is our reading on node-to-segment rows of the scheme of Kolman et al. (2021) and Kwon, Kim, Cho and Gonzalez
    (2025): mass penalties touch contact forces only, and the correction removes the predicted penetration. It does so
    exactly for d = 1, alpha_m = alpha_s dt^2 - 1/w, which s2 = 1 tends to as ps grows.

    Whatever ps and dt, one row held closed on an elastic mesh is stable for d <= 1 (4/3 between free nodes). Rows that
    share nodes do not know of each other: together they correct d times the largest eigenvalue of W over its
    diagonal, 1 to 4/3 with one pass and 2 to 8/3 with two. s2 = 3/8 keeps all of them within the limit; past it growth
    is slow at small time steps, fast near the mesh's limit, where s2 = 1 chatters even with one pass.

    Raises
    ------
    InputError : a parameter out of its bounds.

    Example
    -------
    >>> PredictorCorrector(ps=1e3).label
    'predictor-corrector bipenalty'
    """

    ps: float = 1e3
    s2: float = 1.0

    def __post_init__(self) -> None:
        settle(self, "ps", "s2", required="ps")

    @property
    def stiffness_rule(self) -> Rule:
        """alpha_s = ps E_max."""
        return "factor", self.ps

    @property
    def mass_rule(self) -> Rule:
        """alpha_m = alpha_s dt^2/s2."""
        return "critical", self.s2

    @property
    def enforcement_rule(self) -> Rule:
        """Predictor without contact, corrector with it."""
        return "predictor-corrector", 0.0

    @property
    def label(self) -> str:
        """Name for legends and tables, without ps."""
        return "predictor-corrector bipenalty"
