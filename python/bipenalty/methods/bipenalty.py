"""The bipenalty method: published rule, critical rule, and the one without parameters."""

from __future__ import annotations

import math
from dataclasses import dataclass

from bipenalty import checks
from bipenalty.methods.method import NO_RULE, Rule, settle


@dataclass(frozen=True)
class Bipenalty:
    """Penalties on stiffness, mass and damping: alpha_m = alpha_s / R, the critical time step untouched.

    Parameters
    ----------
    ps : stiffness penalty factor alpha_s / (E_max 1 m), -, >= 0, or "auto" for as stiff as `kappa` allows.
    rule : "critical" or "published".
    kappa : cap alpha_s <= kappa m_e/dt^2 with m_e = 1/(G M^-1 G') the row's effective mass, -, > 0, infinite for no cap;
        5 for the critical rule and no cap for the published one unless given.
    s2 : s^2 = R dt^2 of the critical rule, -, in (0, 2); 1.5 unless given.
    R, R_safety : penalty ratio of the published rule, 1/s^2, > 0; R_safety * 4/dt^2 unless R is given.
    D, zeta : damping of the published rule: alpha_d = D alpha_s (s) or 2 zeta sqrt(alpha_s alpha_m) (-).

    Either rule keeps omega^2 <= max(omega_0^2, R) for any number of rows (Hetherington, Rodriguez-Ferran and
    Askes 2012). The published rule with R near 4/dt^2 still makes energy when rows open and close: in the limit
    alpha_s -> inf one row takes w -> [(1 - zeta s) w - s^2 g] / (1 + zeta s), g -> g + w a step (dt = 1,
    s = sqrt(R) dt), and leaves faster than it came for most phases of entry. The critical rule sets zeta s = 1,

        alpha_m = alpha_s dt^2/s^2,  alpha_d = 2 alpha_m/dt:

    the entering velocity is gone after one step, the gap decays by 1 - s^2/2 a step without crossing zero, and the
    restitution is 0 for every phase (see `bipenalty.restitution`). The cap keeps rows that share nodes from
    throwing them at each other.

    Raises
    ------
    InputError : a parameter out of its bounds, or one that belongs to the other rule.

    Example
    -------
    >>> Bipenalty().label
    'parameter-free bipenalty'
    >>> Bipenalty(ps=10.0, rule="published", D=0.01).label
    'bipenalty (D = 0.01)'
    """

    ps: float | str = "auto"
    rule: str = "critical"
    kappa: float | None = None
    s2: float | None = None
    R: float | None = None
    R_safety: float | None = None
    D: float | None = None
    zeta: float | None = None

    def __post_init__(self) -> None:
        known = self.rule in ("critical", "published")
        checks.within("Bipenalty", "rule", repr(self.rule), known, '"critical" or "published"', "name one of the two")
        foreign = ("R", "R_safety", "D", "zeta") if self.rule == "critical" else ("s2",)
        other = "published" if self.rule == "critical" else "critical"
        for name in foreign:
            value = getattr(self, name)
            remedy = f'it belongs to rule="{other}"'
            checks.within("Bipenalty", name, value, value is None, f'left out for rule="{self.rule}"', remedy)
        checks.within("Bipenalty", "D and zeta", (self.D, self.zeta), self.D is None or self.zeta is None,
                      "given one at a time", "zeta = D sqrt(R) / 2: leave one out")  # fmt: skip
        checks.within("Bipenalty", "R and R_safety", (self.R, self.R_safety), self.R is None or self.R_safety is None,
                      "given one at a time", "R_safety takes R from dt: leave one out")  # fmt: skip
        if isinstance(self.ps, str):
            checks.within("Bipenalty", "ps", repr(self.ps), self.ps == "auto", 'a number or "auto"', "correct it")
            capped = self.rule == "critical" or self.kappa is not None
            checks.within(
                "Bipenalty", "ps", repr(self.ps), capped, 'a number for rule="published"', "give ps, or kappa"
            )
        named = ("kappa", "s2", "R", "R_safety", "D", "zeta")
        settle(self, *named) if self.ps == "auto" else settle(self, "ps", *named, required="ps")

    @property
    def stiffness_rule(self) -> Rule:
        """alpha_s = ps E_max, or what the cap allows."""
        return ("capped", 0.0) if isinstance(self.ps, str) else ("factor", self.ps)

    @property
    def kappa_rule(self) -> float:
        """Cap on alpha_s; infinite for none."""
        if self.kappa is not None:
            return self.kappa
        return 5.0 if self.rule == "critical" else math.inf

    @property
    def mass_rule(self) -> Rule:
        """alpha_m = alpha_s / R."""
        if self.rule == "critical":
            return "critical", 1.5 if self.s2 is None else self.s2
        if self.R is not None:
            return "ratio", self.R
        return "ratio from step", 0.9 if self.R_safety is None else self.R_safety

    @property
    def damping_rule(self) -> Rule:
        """alpha_d = 2 alpha_m/dt, or by D or zeta."""
        if self.rule == "critical":
            return "critical", 0.0
        if self.D is not None:
            return "factor", self.D
        return NO_RULE if self.zeta is None else ("ratio", self.zeta)

    @property
    def label(self) -> str:
        """Name for legends and tables, without ps."""
        if self.rule == "critical":
            return "parameter-free bipenalty" if self.ps == "auto" else "critical bipenalty"
        if self.D:
            return f"bipenalty (D = {self.D:g})"
        return f"bipenalty (zeta = {self.zeta:g})" if self.zeta else "bipenalty"
